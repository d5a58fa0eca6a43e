#include "tools/simulator/renderer.hpp"

#include "pipeline/base/parallel.hpp"
#include "tools/simulator/projected_chessboard.hpp"
#include "tools/simulator/projected_picture.hpp"
#include "tools/simulator/sensor.hpp"
#include "tools/simulator/skin.hpp"
#include "tools/simulator/subjects.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace bodyscan::simulator {
namespace {

constexpr int rows_at_once = 8;
constexpr float albedo_unit = 65535;
// In pixel footprints: how far a pixel's rays may lie off its tangent plane, and a neighbour off its
// continuation.
constexpr float flatness = 0.25F;
constexpr float smallest_jump = 0.5F;
const double smallest_cosine = std::cos(largest_incidence_degrees * std::numbers::pi / 180);

// Offset from the pixel's centre of the i-th of n rays along a side.
double ray_offset(int i, int n) {
  return (i + 0.5) / n - 0.5;
}

// How far `there` lies off the smooth continuation of `here`: of two points of one curved surface each lies
// on the same side of the other's tangent plane, of two points beside a jump on opposite sides.
float jump(const Eigen::Vector3f& here, const Eigen::Vector3f& here_normal, const Eigen::Vector3f& there,
           const Eigen::Vector3f& there_normal) {
  return std::abs((here_normal + there_normal).dot(there - here)) / 2;
}

// Takes out of the reachable set what has a neighbour that is none, or a jump to a neighbour.
void keep_inner(const Lens& camera, TruthMaps& maps) {
  const Size size = camera.size;
  Image<Eigen::Vector3f> points(size);
  parallel_for(0, size.height, rows_at_once, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      for (int x = 0; x < size.width; ++x) {
        if (maps.reachable(x, y) == 0) continue;
        const double depth = static_cast<double>(maps.depth(x, y));
        points(x, y) = (depth * camera.ray(Eigen::Vector2d(x, y))).cast<float>();
      }
    }
  });
  const GrayImage8 before = maps.reachable.clone();
  const auto joins = [&](int x, int y, int next_x, int next_y) {
    if (next_x < 0 || next_y < 0 || next_x >= size.width || next_y >= size.height) return false;
    if (before(next_x, next_y) == 0) return false;
    const float tolerance = smallest_jump * maps.depth(x, y) / static_cast<float>(camera.fx);
    return jump(points(x, y), maps.normal(x, y), points(next_x, next_y), maps.normal(next_x, next_y)) <=
           tolerance;
  };
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      if (before(x, y) == 0) continue;
      if (!joins(x, y, x - 1, y) || !joins(x, y, x + 1, y) || !joins(x, y, x, y - 1) ||
          !joins(x, y, x, y + 1))
        maps.reachable(x, y) = 0;
    }
  }
}

}  // namespace

Renderer::Renderer(const Scene& scene, const RenderOptions& options, Tracer tracer)
    : scene_(&scene), options_(options), tracer_(std::move(tracer)) {
  constexpr double matt_white = 0.75;  // of full scale
  white_ = options.light * matt_white / static_cast<double>(matt_albedo);
  const Eigen::Vector3d reference(0, 0, reference_distance);
  reference_distance2_ = (scene.calibration.projector_from_camera * reference).squaredNorm();
  const double by_material = scene.subject.material == Material::skin ? 0.5 : 0;
  const double share = options.subsurface < 0 ? by_material : options.subsurface;
  // Red light travels farthest under the skin.
  scattered_share_ = {static_cast<float>(std::min(1.0, 1.3 * share)), static_cast<float>(share),
                      static_cast<float>(0.75 * share)};
}

Expected<Renderer> Renderer::make(const Scene& scene, const RenderOptions& options) {
  Expected<Tracer> tracer = Tracer::make(scene);
  if (!tracer) return tl::unexpected(tracer.error());
  Renderer renderer(scene, options, std::move(*tracer));
  if (options.motion.isZero()) renderer.still_ = renderer.trace(Eigen::Vector3d::Zero());
  return renderer;
}

// Share of the projector's light that reaches this place of its picture.
double Renderer::evenness(const Illumination& light) const {
  const Size size = scene_->calibration.projector.size;
  const double way = (light.column / (size.width - 1) + light.row / (size.height - 1)) / 2;
  return 1 - options_.uneven_light * std::clamp(way, 0.0, 1.0);
}

Renderer::SubRay Renderer::trace_ray(const Eigen::Vector2d& pixel, const Eigen::Vector3d& offset) const {
  SubRay ray{};
  const std::optional<SurfaceHit> hit = tracer_.hit(scene_->calibration.camera.ray(pixel), offset);
  if (!hit) return ray;
  const Illumination light = tracer_.illumination(*hit, offset);
  ray.hit = 1;
  ray.row = static_cast<float>(light.row);
  ray.column = static_cast<float>(light.column);
  if (light.direct)
    ray.direct = static_cast<float>(white_ * light.cosine * evenness(light) * reference_distance2_ /
                                    (light.distance * light.distance));
  for (int c = 0; c < 3; ++c)
    ray.albedo[static_cast<std::size_t>(c)] =
        static_cast<std::uint16_t>(std::clamp(hit->albedo[c], 0.0F, 1.0F) * albedo_unit + 0.5F);
  return ray;
}

Renderer::Samples Renderer::trace(const Eigen::Vector3d& offset) const {
  const Size size = scene_->calibration.camera.size;
  const int n = options_.rays;
  Samples samples{std::vector<std::array<int, 2>>(static_cast<std::size_t>(size.height)),
                  Image<SubRay>({size.width * n * n, size.height})};
  parallel_for(0, size.height, rows_at_once, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      SubRay* ray = samples.rays.row(y);
      int first = size.width;
      int last = -1;
      for (int x = 0; x < size.width; ++x) {
        bool any = false;
        for (int j = 0; j < n; ++j) {
          for (int i = 0; i < n; ++i, ++ray) {
            *ray = trace_ray({x + ray_offset(i, n), y + ray_offset(j, n)}, offset);
            any = any || ray->hit != 0;
          }
        }
        if (!any) continue;
        first = std::min(first, x);
        last = x;
      }
      samples.spans[static_cast<std::size_t>(y)] = {first, last + 1};
    }
  });
  return samples;
}

double Renderer::scattered_blur() const {
  const bool scatters = scattered_share_[1] > 0;
  return scatters ? std::hypot(options_.defocus, options_.subsurface_blur) : options_.defocus;
}

ColorImage8 Renderer::frame(const Pattern& pattern, int index) const {
  return frame(
      ProjectedLight(pattern, scene_->calibration.projector.size, options_.defocus, scattered_blur()), index,
      1);
}

ColorImage8 Renderer::frame(const ProjectedLight& light, int index, float gain) const {
  if (light.axis() == Axis::row)
    return picture([&](const SubRay& ray) { return light.at(ray.row); }, light.mean(), index, gain);
  return picture([&](const SubRay& ray) { return light.at(ray.column); }, light.mean(), index, gain);
}

ColorImage8 Renderer::frame(const FloatImage& shown, int index, float gain) const {
  if (const std::optional<Axis> axis = changing_axis(shown))
    return frame(ProjectedLight(pixels_along(shown, *axis), *axis, options_.defocus, scattered_blur()), index,
                 gain);
  const ProjectedPicture light(shown, options_.defocus, scattered_blur());
  return picture([&](const SubRay& ray) { return light.at(ray.column, ray.row); }, light.mean(), index, gain);
}

ColorImage8 Renderer::frame(const ProjectedBoard& board, int index) const {
  const ProjectedChessboard light(board, scene_->calibration.projector.size, options_.defocus,
                                  scattered_blur());
  return picture([&](const SubRay& ray) { return light.at(ray.column, ray.row); }, light.mean(), index);
}

template <class Shown>
ColorImage8 Renderer::picture(const Shown& shown, float mean, int index, float gain) const {
  Samples moved;
  if (!options_.motion.isZero()) moved = trace(index * options_.motion);
  Lit lit = light(options_.motion.isZero() ? still_ : moved, shown, mean, gain);
  if (options_.lens_blur > 0 && !lit.light.empty()) blur_light(lit.light, options_.lens_blur);
  return expose(lit, index);
}

// The bounding box of what the rays met, with room for the lens's blur.
Renderer::Lit Renderer::lit_part(const Samples& samples) const {
  const Size size = scene_->calibration.camera.size;
  int left = size.width;
  int right = 0;
  int top = size.height;
  int bottom = 0;
  for (int y = 0; y < size.height; ++y) {
    const auto [first, last] = samples.spans[static_cast<std::size_t>(y)];
    if (first >= last) continue;
    left = std::min(left, first);
    right = std::max(right, last);
    top = std::min(top, y);
    bottom = y + 1;
  }
  if (left >= right) return {};
  const int reach = lens_blur_reach(options_.lens_blur);
  Lit lit{std::max(0, left - reach), std::max(0, top - reach), {}};
  lit.light = LightImage(
      {std::min(size.width, right + reach) - lit.left, std::min(size.height, bottom + reach) - lit.top});
  return lit;
}

template <class Shown>
Renderer::Lit Renderer::light(const Samples& samples, const Shown& shown, float mean, float gain) const {
  const auto black = static_cast<float>(1 / options_.contrast);
  const auto indirect =
      static_cast<float>(white_ * options_.reflection * static_cast<double>(black + (1 - black) * mean) +
                         options_.ambient / static_cast<double>(matt_albedo));
  const int rays = options_.rays * options_.rays;
  const float ray_weight = gain / (static_cast<float>(rays) * albedo_unit);
  Lit lit = lit_part(samples);
  parallel_for(0, lit.light.height(), rows_at_once, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      const auto [first, last] = samples.spans[static_cast<std::size_t>(lit.top + y)];
      for (int x = 0; x < lit.light.width(); ++x) {
        std::array<float, 3> sum{};
        if (lit.left + x >= first && lit.left + x < last) {
          const SubRay* ray =
              samples.rays.row(lit.top + y) + static_cast<std::ptrdiff_t>(lit.left + x) * rays;
          for (int k = 0; k < rays; ++k, ++ray) {
            if (ray->hit == 0) continue;
            const BlurredRow::Value value = ray->direct > 0 ? shown(*ray) : BlurredRow::Value{};
            for (unsigned c = 0; c < 3; ++c) {
              const float share = value.focused + scattered_share_[c] * value.scatter_change;
              sum[c] += ray->albedo[c] * (ray->direct * (black + (1 - black) * share) + indirect);
            }
          }
          for (float& channel : sum) channel *= ray_weight;
        }
        lit.light(x, y) = sum;
      }
    }
  });
  return lit;
}

ColorImage8 Renderer::expose(const Lit& lit, int index) const {
  const Sensor sensor(options_.full_well, options_.read_noise, options_.seed,
                      static_cast<std::uint64_t>(index));
  ColorImage8 image(scene_->calibration.camera.size);
  parallel_for(0, image.height(), rows_at_once, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      const bool any = y >= lit.top && y < lit.top + lit.light.height();
      const std::array<float, 3>* light = any ? lit.light.row(y - lit.top) : nullptr;
      const int first = any ? lit.left : image.width();
      const int last = any ? lit.left + lit.light.width() : image.width();
      auto pixel = static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(image.width());
      for (int x = 0; x < image.width(); ++x, ++pixel)
        image(x, y) =
            sensor.expose(x >= first && x < last ? light[x - first] : std::array<float, 3>{}, pixel);
    }
  });
  return image;
}

void Renderer::truth_at(int x, int y, TruthMaps& maps) const {
  constexpr float none = std::numeric_limits<float>::quiet_NaN();
  maps.depth(x, y) = 0;
  maps.normal(x, y).setZero();
  maps.rows(x, y) = maps.columns(x, y) = none;
  maps.reachable(x, y) = 0;
  const Lens& camera = scene_->calibration.camera;
  const Eigen::Vector3d still = Eigen::Vector3d::Zero();
  const auto reaches = [](const SurfaceHit& hit, const Illumination& light) {
    return light.direct && light.cosine >= smallest_cosine &&
           -hit.normal.dot(hit.point.normalized()) >= smallest_cosine;
  };

  const std::optional<SurfaceHit> center = tracer_.hit(camera.ray(Eigen::Vector2d(x, y)), still);
  if (!center) return;
  const Illumination light = tracer_.illumination(*center, still);
  maps.depth(x, y) = static_cast<float>(center->point.z());
  maps.normal(x, y) = center->normal.cast<float>();
  if (!light.direct) return;
  maps.rows(x, y) = static_cast<float>(light.row);
  maps.columns(x, y) = static_cast<float>(light.column);
  if (!reaches(*center, light)) return;

  const double tolerance = static_cast<double>(flatness) * center->point.z() / camera.fx;
  const int n = options_.rays;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const Eigen::Vector2d at(x + ray_offset(i, n), y + ray_offset(j, n));
      const std::optional<SurfaceHit> hit = tracer_.hit(camera.ray(at), still);
      if (!hit || std::abs(center->face_normal.dot(hit->point - center->point)) > tolerance) return;
      if (!reaches(*hit, tracer_.illumination(*hit, still))) return;
    }
  }
  maps.reachable(x, y) = 255;
}

TruthMaps Renderer::truth() const {
  const Size size = scene_->calibration.camera.size;
  TruthMaps maps{FloatImage(size), Image<Eigen::Vector3f>(size), FloatImage(size), FloatImage(size),
                 GrayImage8(size)};
  parallel_for(0, size.height, rows_at_once, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      for (int x = 0; x < size.width; ++x) truth_at(x, y, maps);
    }
  });
  keep_inner(scene_->calibration.camera, maps);
  return maps;
}

}  // namespace bodyscan::simulator
