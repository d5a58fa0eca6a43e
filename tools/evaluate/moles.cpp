#include "tools/evaluate/moles.hpp"

#include "pipeline/base/parallel.hpp"
#include "pipeline/image/srgb.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace bodyscan {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

const std::array<float, 256>& linear_from_srgb() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = static_cast<float>(srgb_to_linear(static_cast<double>(i) / 255));
    }
    return values;
  }();
  return table;
}

float brightness(const Rgb8& color) {
  const std::array<float, 256>& linear = linear_from_srgb();
  return (linear[color[0]] + linear[color[1]] + linear[color[2]]) / 3;
}

struct Corner {
  Vector2d pixel;
  double depth;
  float brightness;
};

double cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Pixels whose centres the triangle covers, edges included; the nearest surface wins.
void draw(const std::array<Corner, 3>& corners, FloatImage& image, FloatImage& depth) {
  const auto [a, b, c] = corners;
  const double area = cross(b.pixel - a.pixel, c.pixel - a.pixel);
  if (area == 0 || !std::isfinite(area)) return;
  const auto first = [](double low) { return std::max(0, static_cast<int>(std::ceil(low - 1e-3))); };
  const auto last = [](double high, int side) {
    return std::min(side - 1, static_cast<int>(std::floor(high + 1e-3)));
  };
  const Vector2d low = a.pixel.cwiseMin(b.pixel).cwiseMin(c.pixel);
  const Vector2d high = a.pixel.cwiseMax(b.pixel).cwiseMax(c.pixel);
  for (int y = first(low.y()); y <= last(high.y(), image.height()); ++y) {
    for (int x = first(low.x()); x <= last(high.x(), image.width()); ++x) {
      const Vector2d at(x, y);
      const double weight_a = cross(b.pixel - at, c.pixel - at) / area;
      const double weight_b = cross(c.pixel - at, a.pixel - at) / area;
      const double weight_c = 1 - weight_a - weight_b;
      if (std::min({weight_a, weight_b, weight_c}) < -2e-3)
        continue;  // grid points lie on their pixel's centre
      const auto z = static_cast<float>(weight_a * a.depth + weight_b * b.depth + weight_c * c.depth);
      if (!(z < depth(x, y))) continue;
      depth(x, y) = z;
      image(x, y) =
          static_cast<float>(weight_a * a.brightness + weight_b * b.brightness + weight_c * c.brightness);
    }
  }
}

// Nothing for a mole that is partly hidden or outside the picture.
std::optional<MoleResult> measure_mole(const Truth& truth, const Mole& mole, const FloatImage& model,
                                       const ColorImage8& white) {
  MoleResult result{.diameter_mm = mole.diameter};
  const Lens& camera = truth.calibration.camera;
  const Vector2d center = camera.project(mole.center);
  const double reach = mole.diameter * camera.fx / mole.center.z();  // px
  std::vector<float> seen;
  std::vector<float> kept;
  for (int y = static_cast<int>(center.y() - reach); y <= static_cast<int>(center.y() + reach); ++y) {
    for (int x = static_cast<int>(center.x() - reach); x <= static_cast<int>(center.x() + reach); ++x) {
      if (x < 0 || y < 0 || x >= white.width() || y >= white.height()) return std::nullopt;
      const Point3f& at = truth.points(x, y);
      if ((Vector3d(at.x, at.y, at.z) - mole.center).norm() > mole.diameter) continue;
      if (!truth.reachable(x, y)) return std::nullopt;
      ++result.pixels;
      if (std::isnan(model(x, y))) continue;
      seen.push_back(brightness(white(x, y)));
      kept.push_back(model(x, y));
    }
  }
  if (result.pixels == 0) return std::nullopt;
  result.covered = static_cast<double>(seen.size()) / static_cast<double>(result.pixels);
  result.contrast_kept = regress(seen, kept).slope;
  return result;
}

}  // namespace

FloatImage model_brightness(const Lens& camera, const Mesh& model) {
  FloatImage image(camera.size, std::numeric_limits<float>::quiet_NaN());
  FloatImage depth(camera.size, std::numeric_limits<float>::infinity());
  if (model.colors.size() != model.points.size()) return image;
  std::vector<Corner> corners(model.points.size());
  parallel_for(0, static_cast<int>(corners.size()), 16384, [&](int begin, int end) {
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
      const Point3f& point = model.points[i];
      corners[i] = {camera.project({point.x, point.y, point.z}), point.z, brightness(model.colors[i])};
    }
  });
  for (const Face& face : model.faces) {
    const std::array<Corner, 3> triangle{corners[face[0]], corners[face[1]], corners[face[2]]};
    if (std::ranges::all_of(triangle, [](const Corner& corner) { return corner.depth > 0; })) {
      draw(triangle, image, depth);
    }
  }
  if (!model.faces.empty()) return image;
  for (const Corner& corner : corners) {
    if (!(corner.depth > 0)) continue;
    const double x = std::round(corner.pixel.x());
    const double y = std::round(corner.pixel.y());
    if (x >= 0 && y >= 0 && x < image.width() && y < image.height()) {
      image(static_cast<int>(x), static_cast<int>(y)) = corner.brightness;
    }
  }
  return image;
}

std::vector<MoleResult> measure_moles(const Truth& truth, const Mesh& model, const ColorImage8& white) {
  std::vector<MoleResult> results;
  if (truth.facts.moles.empty() || white.size() != truth.calibration.camera.size) return results;
  const FloatImage image = model_brightness(truth.calibration.camera, model);
  for (const Mole& mole : truth.facts.moles) {
    if (const std::optional<MoleResult> result = measure_mole(truth, mole, image, white)) {
      results.push_back(*result);
    }
  }
  return results;
}

}  // namespace bodyscan
