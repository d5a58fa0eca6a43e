#include "tools/evaluate/deviation.hpp"

#include "pipeline/base/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bodyscan {
namespace {

using Eigen::Vector3d;

Vector3d to_vector(const Point3f& point) {
  return {point.x, point.y, point.z};
}

std::int32_t pixel_of(const Lens& camera, const Vector3d& point) {
  if (!(point.z() > 0)) return -1;
  const Eigen::Vector2d place = camera.project(point);
  if (!(place.x() > -0.5 && place.y() > -0.5 && place.x() < camera.size.width - 0.5 &&
        place.y() < camera.size.height - 0.5)) {
    return -1;
  }
  return static_cast<std::int32_t>(std::lround(place.y()) * camera.size.width + std::lround(place.x()));
}

double distance_to_truth(const Truth& truth, const Vector3d& point, std::int32_t pixel) {
  double at_most = std::numeric_limits<double>::infinity();
  if (pixel >= 0 && truth.depth.data()[pixel] > 0) {
    const Vector3d offset = point - to_vector(truth.points.data()[pixel]);
    const double along_normal = offset.dot(to_vector(truth.normals.data()[pixel]));
    if (std::abs(along_normal) <= tangent_limit_mm) return along_normal;
    at_most = offset.norm() + 0.1;  // mm, more than the rounding of the mesh's corners
  }
  return truth.surface.signed_distance(point, at_most);
}

}  // namespace

Deviations measure_deviations(const Truth& truth, std::span<const Point3f> points) {
  Deviations result;
  result.distance.resize(points.size());
  result.pixel.resize(points.size());
  parallel_for(0, static_cast<int>(points.size()), 16384, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const Vector3d point = to_vector(points[at]);
      result.pixel[at] = pixel_of(truth.calibration.camera, point);
      result.distance[at] = static_cast<float>(distance_to_truth(truth, point, result.pixel[at]));
    }
  });
  return result;
}

Coverage measure_coverage(const Truth& truth, const Deviations& deviations) {
  std::vector<bool> met(truth.reachable.size().area(), false);
  for (std::size_t i = 0; i < deviations.pixel.size(); ++i) {
    if (deviations.pixel[i] >= 0 && std::abs(deviations.distance[i]) <= wrong_mm) {
      met[static_cast<std::size_t>(deviations.pixel[i])] = true;
    }
  }
  Coverage coverage;
  for (std::size_t pixel = 0; pixel < met.size(); ++pixel) {
    if (!truth.reachable.data()[pixel]) continue;
    ++coverage.reachable;
    if (met[pixel]) ++coverage.covered;
  }
  return coverage;
}

double share_wrong(const Deviations& deviations) {
  if (deviations.distance.empty()) return 0;
  const auto wrong = std::ranges::count_if(deviations.distance,
                                           [](float distance) { return std::abs(distance) > wrong_mm; });
  return static_cast<double>(wrong) / static_cast<double>(deviations.distance.size());
}

}  // namespace bodyscan
