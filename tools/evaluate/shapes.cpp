#include "tools/evaluate/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <Eigen/Geometry>

namespace bodyscan {
namespace {

using Eigen::Vector3d;

constexpr double on_shape_mm = 0.02;    // tessellation and float rounding of the truth stay below it
constexpr double astray_mm = 5;         // a few flying points must not decide a least-squares fit
constexpr double ring_inside_mm = 0.3;  // the lenses' blur has decayed there
constexpr double ring_outside_mm = 1.5;

Vector3d to_vector(const Point3f& point) {
  return {point.x, point.y, point.z};
}

// Calls visit(point, true point) for every point that is not astray and whose pixel is reachable.
template <class Visit>
void for_each_judged(const Truth& truth, std::span<const Point3f> points, const Deviations& deviations,
                     Visit&& visit) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::int32_t pixel = deviations.pixel[i];
    if (pixel < 0 || !truth.reachable.data()[pixel] || std::abs(deviations.distance[i]) > astray_mm) continue;
    visit(to_vector(points[i]), to_vector(truth.points.data()[pixel]));
  }
}

template <class Shape>
std::vector<std::vector<Vector3d>> points_on(const Truth& truth, std::span<const Point3f> points,
                                             const Deviations& deviations, const std::vector<Shape>& shapes) {
  std::vector<std::vector<Vector3d>> members(shapes.size());
  for_each_judged(truth, points, deviations, [&](const Vector3d& point, const Vector3d& true_point) {
    for (std::size_t k = 0; k < shapes.size(); ++k) {
      if (std::abs(shapes[k].distance(true_point)) < on_shape_mm) members[k].push_back(point);
    }
  });
  return members;
}

std::vector<Plane> planes_of(const std::vector<NamedPlane>& named) {
  std::vector<Plane> planes;
  for (const NamedPlane& one : named) planes.push_back(one.plane);
  return planes;
}

template <class Shape>
Statistics residuals(const Shape& shape, const std::vector<Vector3d>& points) {
  std::vector<float> distances;
  distances.reserve(points.size());
  for (const Vector3d& point : points) distances.push_back(static_cast<float>(shape.distance(point)));
  return summarize(distances);
}

// The plane's normal turned so that relief towards the camera is positive.
Plane facing_camera(Plane plane) {
  if (plane.offset > 0) plane = {-plane.normal, -plane.offset};
  return plane;
}

struct ReliefSamples {
  std::vector<float> measured;  // mm
  std::vector<float> expected;
  double ring_measured = 0;
  double ring_expected = 0;
  std::size_t ring_points = 0;
};

// Buckets of the base plane, so that a point finds the bumps around it without asking all.
class BumpFinder {
 public:
  BumpFinder(const std::vector<Bump>& bumps, const Plane& base) : bumps_(bumps) {
    across_ = base.normal.unitOrthogonal();
    down_ = base.normal.cross(across_);
    for (std::size_t i = 0; i < bumps.size(); ++i) {
      const double reach = bumps[i].diameter / 2 + ring_outside_mm;
      const auto [x, y] = coordinates(bumps[i].center);
      for (int row = cell(y - reach); row <= cell(y + reach); ++row) {
        for (int column = cell(x - reach); column <= cell(x + reach); ++column) {
          cells_[{row, column}].push_back(i);
        }
      }
    }
  }

  // Calls visit(bump, distance from its axis) for the bumps whose ring or relief the point may lie in.
  template <class Visit>
  void around(const Vector3d& point, Visit&& visit) const {
    const auto [x, y] = coordinates(point);
    const auto found = cells_.find({cell(y), cell(x)});
    if (found == cells_.end()) return;
    for (const std::size_t i : found->second) {
      const auto [bump_x, bump_y] = coordinates(bumps_[i].center);
      visit(i, std::hypot(x - bump_x, y - bump_y));
    }
  }

 private:
  static constexpr double cell_mm = 5;
  static int cell(double coordinate) { return static_cast<int>(std::floor(coordinate / cell_mm)); }
  [[nodiscard]] std::pair<double, double> coordinates(const Vector3d& point) const {
    return {point.dot(across_), point.dot(down_)};
  }

  const std::vector<Bump>& bumps_;
  Vector3d across_;
  Vector3d down_;
  std::map<std::pair<int, int>, std::vector<std::size_t>> cells_;
};

std::vector<ReliefSamples> collect_relief(const Truth& truth, std::span<const Point3f> points,
                                          const Deviations& deviations, const Plane& base) {
  const BumpFinder finder(truth.facts.bumps, base);
  std::vector<ReliefSamples> samples(truth.facts.bumps.size());
  for_each_judged(truth, points, deviations, [&](const Vector3d& point, const Vector3d& true_point) {
    const double measured = base.distance(point);
    const double expected = base.distance(true_point);
    finder.around(true_point, [&](std::size_t bump, double radius) {
      ReliefSamples& sample = samples[bump];
      const double beyond = radius - truth.facts.bumps[bump].diameter / 2;
      if (beyond <= 0) {
        sample.measured.push_back(static_cast<float>(measured));
        sample.expected.push_back(static_cast<float>(expected));
      } else if (beyond >= ring_inside_mm && beyond <= ring_outside_mm) {
        sample.ring_measured += measured;
        sample.ring_expected += expected;
        ++sample.ring_points;
      }
    });
  });
  return samples;
}

}  // namespace

std::vector<StepResult> measure_steps(const Truth& truth, std::span<const Point3f> points,
                                      const Deviations& deviations) {
  const std::vector<NamedPlane>& steps = truth.facts.steps;
  const auto members = points_on(truth, points, deviations, planes_of(steps));
  std::vector<StepResult> results;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const Statistics face = residuals(facing_camera(steps[k].plane), members[k]);
    const double variance = std::max(0.0, face.rms * face.rms - face.bias * face.bias);
    const double step_error = k == 0 ? 0 : face.bias - results.back().height_error_mm;
    results.push_back({steps[k].name, face.count, face.bias, std::sqrt(variance), step_error});
  }
  return results;
}

std::vector<SphereResult> measure_spheres(const Truth& truth, std::span<const Point3f> points,
                                          const Deviations& deviations) {
  const std::vector<Sphere>& spheres = truth.facts.spheres;
  const auto members = points_on(truth, points, deviations, spheres);
  std::vector<SphereResult> results;
  for (std::size_t k = 0; k < spheres.size(); ++k) {
    SphereResult result{.points = members[k].size(), .fitted = {}};
    if (members[k].size() >= 4) {
      result.fitted = fit_sphere(members[k]);
      result.diameter_error_mm = 2 * (result.fitted.radius - spheres[k].radius);
      result.form_mm = residuals(result.fitted, members[k]).range_997;
    }
    results.push_back(result);
  }
  return results;
}

double sphere_spacing_error(const Truth& truth, const std::vector<SphereResult>& spheres) {
  if (spheres.size() < 2 || spheres[0].points < 4 || spheres[1].points < 4) return 0;
  const std::vector<Sphere>& expected = truth.facts.spheres;
  return (spheres[1].fitted.center - spheres[0].fitted.center).norm() -
         (expected[1].center - expected[0].center).norm();
}

std::vector<PlaneResult> measure_planes(const Truth& truth, std::span<const Point3f> points,
                                        const Deviations& deviations) {
  const auto members = points_on(truth, points, deviations, planes_of(truth.facts.planes));
  std::vector<PlaneResult> results;
  for (std::size_t k = 0; k < members.size(); ++k) {
    PlaneResult result{.name = truth.facts.planes[k].name, .points = members[k].size()};
    if (members[k].size() >= 3) {
      const Statistics off = residuals(fit_plane(members[k]), members[k]);
      result.flatness_mm = off.range_997;
      result.noise_mm = off.rms;
    }
    results.push_back(result);
  }
  return results;
}

std::vector<BumpResult> measure_bumps(const Truth& truth, std::span<const Point3f> points,
                                      const Deviations& deviations) {
  const std::vector<Bump>& bumps = truth.facts.bumps;
  if (bumps.empty() || truth.facts.planes.empty()) return {};
  const Plane base = facing_camera(truth.facts.planes[0].plane);
  const std::vector<ReliefSamples> samples = collect_relief(truth, points, deviations, base);

  std::map<std::pair<double, double>, std::pair<ReliefSamples, std::size_t>> classes;
  for (std::size_t i = 0; i < bumps.size(); ++i) {
    if (samples[i].measured.empty() || samples[i].ring_points == 0) continue;
    const double ring = static_cast<double>(samples[i].ring_points);
    const double offset = (samples[i].ring_measured - samples[i].ring_expected) / ring;
    auto& [pooled, count] = classes[{bumps[i].diameter, bumps[i].height}];
    ++count;
    for (const float measured : samples[i].measured) {
      pooled.measured.push_back(static_cast<float>(measured - offset));
    }
    pooled.expected.insert(pooled.expected.end(), samples[i].expected.begin(), samples[i].expected.end());
  }
  std::vector<BumpResult> results;
  for (const auto& [key, entry] : classes) {
    const auto& [pooled, count] = entry;
    results.push_back({key.first, key.second, count, pooled.measured.size(),
                       regress(pooled.expected, pooled.measured).slope});
  }
  return results;
}

}  // namespace bodyscan
