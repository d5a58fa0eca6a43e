#include "pipeline/preview/shaded_model.hpp"

#include "pipeline/base/parallel.hpp"
#include "pipeline/preview/coarse_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

namespace bodyscan {
namespace {

using Eigen::Vector3f;

constexpr int samples = 2;       // a pixel's side, for smooth edges
constexpr float margin = 0.03F;  // share of the picture on each side
constexpr float ambient = 0.22F;
constexpr float exposure = 1.5F;  // the colours hold the projector's own shading already

// A vertex in the picture: samples from the left and the top, depth away from the viewer.
struct Seen {
  Vector3f position;
  Vector3f light;  // linear
};

struct Canvas {
  Image<Vector3f> light;  // negative where nothing was drawn
  FloatImage depth;

  explicit Canvas(Size size)
      : light(size, Vector3f(-1, -1, -1)), depth(size, std::numeric_limits<float>::infinity()) {}
};

float edge(const Vector3f& p, const Vector3f& q, float x, float y) {
  return (q.x() - p.x()) * (y - p.y()) - (q.y() - p.y()) * (x - p.x());
}

// The part of a triangle in rows [top, bottom), hidden by what is nearer.
void fill(const Seen& a, const Seen& b, const Seen& c, int top, int bottom, Canvas& canvas) {
  const float area = edge(a.position, b.position, c.position.x(), c.position.y());
  if (area == 0) return;
  const auto [left, right] = std::minmax({a.position.x(), b.position.x(), c.position.x()});
  const auto [upper, lower] = std::minmax({a.position.y(), b.position.y(), c.position.y()});
  const int first_x = std::max(0, static_cast<int>(std::ceil(left)));
  const int last_x = std::min(canvas.depth.width() - 1, static_cast<int>(std::floor(right)));
  const int first_y = std::max(top, static_cast<int>(std::ceil(upper)));
  const int last_y = std::min(bottom - 1, static_cast<int>(std::floor(lower)));
  for (int y = first_y; y <= last_y; ++y) {
    for (int x = first_x; x <= last_x; ++x) {
      const auto u = static_cast<float>(x);
      const auto v = static_cast<float>(y);
      const float wa = edge(b.position, c.position, u, v) / area;
      const float wb = edge(c.position, a.position, u, v) / area;
      const float wc = 1 - wa - wb;
      if (wa < 0 || wb < 0 || wc < 0) continue;
      const float depth = wa * a.position.z() + wb * b.position.z() + wc * c.position.z();
      if (depth >= canvas.depth(x, y)) continue;
      canvas.depth(x, y) = depth;
      canvas.light(x, y) = wa * a.light + wb * b.light + wc * c.light;
    }
  }
}

// Vertices turned, lit and fitted into the limits; gives the picture's size too.
struct View {
  Size size;
  std::vector<Seen> vertices;
};

View look(const CoarseMesh& mesh, const ShadedModelOptions& options) {
  const auto radians = [](double degrees) { return static_cast<float>(degrees * std::numbers::pi / 180); };
  const Eigen::Matrix3f turn = (Eigen::AngleAxisf(radians(options.tilt_deg), Vector3f::UnitX()) *
                                Eigen::AngleAxisf(-radians(options.turn_deg), Vector3f::UnitY()))
                                   .toRotationMatrix();
  const Vector3f to_light = Vector3f(-0.45F, -0.55F, -1).normalized();
  View view;
  Vector3f low = Vector3f::Constant(std::numeric_limits<float>::infinity());
  Vector3f high = -low;
  for (const CoarseVertex& vertex : mesh.vertices) {
    const Vector3f position = turn * vertex.position;
    const Vector3f normal = turn * vertex.normal;
    const float facing = normal.dot(to_light);
    // Turned away from the viewer, the surface shows its dim inside.
    const float shade = normal.z() > 0 ? ambient : ambient + (1 - ambient) * std::max(0.F, facing);
    view.vertices.push_back({position, exposure * shade * vertex.color});
    low = low.cwiseMin(position);
    high = high.cwiseMax(position);
  }
  const Vector3f extent = (high - low).cwiseMax(1e-3F);
  const float usable = 1 - 2 * margin;
  const float scale = usable * std::min(static_cast<float>(options.max_width) / extent.x(),
                                        static_cast<float>(options.max_height) / extent.y());
  const auto side = [&](float length, int limit) {
    return std::clamp(static_cast<int>(std::ceil(length * scale / usable)), 1, limit);
  };
  view.size = {side(extent.x(), options.max_width), side(extent.y(), options.max_height)};
  const Vector3f middle = (low + high) / 2;
  const Vector3f screen_middle(static_cast<float>(view.size.width), static_cast<float>(view.size.height), 0);
  for (Seen& vertex : view.vertices) {
    vertex.position = (vertex.position - middle) * (scale * samples) + screen_middle * (samples / 2.F);
  }
  return view;
}

void draw(const CoarseMesh& mesh, const View& view, Canvas& canvas) {
  const int height = canvas.depth.height();
  const int band = (height + thread_count() - 1) / thread_count();
  parallel_for(0, height, band, [&](int top, int bottom) {
    for (const auto& [p, q, r] : mesh.faces) {
      fill(view.vertices[p], view.vertices[q], view.vertices[r], top, bottom, canvas);
    }
  });
}

// Means of the samples of each pixel, encoded.
ColorImage8 develop(const Canvas& canvas, const ShadedModelOptions& options) {
  constexpr float gamma = 2.2F;
  Vector3f background;
  for (int i = 0; i < 3; ++i) {
    background[i] =
        std::pow(static_cast<float>(options.background[static_cast<std::size_t>(i)]) / 255, gamma);
  }
  ColorImage8 picture(Size{canvas.depth.width() / samples, canvas.depth.height() / samples});
  parallel_for(0, picture.height(), 32, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      for (int x = 0; x < picture.width(); ++x) {
        Vector3f sum = Vector3f::Zero();
        for (int v = 0; v < samples; ++v) {
          for (int u = 0; u < samples; ++u) {
            const Vector3f& light = canvas.light(x * samples + u, y * samples + v);
            sum += light.x() < 0 ? background : light;
          }
        }
        const Vector3f mean = (sum / (samples * samples)).cwiseMin(1);
        for (int i = 0; i < 3; ++i) {
          picture(x, y)[static_cast<std::size_t>(i)] =
              static_cast<std::uint8_t>(std::lround(255 * std::pow(mean[i], 1 / gamma)));
        }
      }
    }
  });
  return picture;
}

// Pixels of the full mesh that become one vertex, so that those are about as dense as the picture's pixels.
int reduction(const GridMesh& mesh, const ShadedModelOptions& options) {
  int left = mesh.size().width;
  int right = 0;
  int top = mesh.size().height;
  int bottom = 0;
  for (int y = 0; y < mesh.size().height; ++y) {
    const std::uint8_t* cells = mesh.cells().row(y);
    for (int x = 0; x < mesh.size().width; ++x) {
      if (!(cells[x] & cell::used)) continue;
      left = std::min(left, x);
      right = std::max(right, x);
      top = std::min(top, y);
      bottom = y;
    }
  }
  return std::max({1, (right - left) / options.max_width + 1, (bottom - top) / options.max_height + 1});
}

}  // namespace

ColorImage8 shaded_model(const GridMesh& mesh, const SurfaceColor* colors,
                         const ShadedModelOptions& options) {
  const CoarseMesh coarse = coarse_mesh(mesh, colors, reduction(mesh, options));
  if (coarse.faces.empty()) {
    return ColorImage8(Size{options.max_width, options.max_height}, options.background);
  }
  const View view = look(coarse, options);
  Canvas canvas(Size{view.size.width * samples, view.size.height * samples});
  draw(coarse, view, canvas);
  return develop(canvas, options);
}

}  // namespace bodyscan
