#pragma once

#include "tools/evaluate/truth.hpp"

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace bodyscan {

// What a camera ray meets: the point and the surface's normal towards the camera.
struct Hit {
  Eigen::Vector3d point;
  Eigen::Vector3d normal;
};
using RayCaster = std::function<std::optional<Hit>(const Eigen::Vector3d& ray)>;

inline Lens small_camera() {
  return {
      .size = {240, 160}, .fx = 800, .fy = 800, .cx = 119.5, .cy = 79.5, .distortion = {-0.09, 0.1, 0, 0, 0}};
}

inline std::optional<Hit> hit_plane(const Plane& plane, const Eigen::Vector3d& ray) {
  return Hit{ray * (plane.offset / plane.normal.dot(ray)), plane.normal};
}

inline std::optional<Hit> hit_sphere(const Sphere& sphere, const Eigen::Vector3d& ray) {
  const double a = ray.squaredNorm();
  const double b = ray.dot(sphere.center);
  const double root = b * b - a * (sphere.center.squaredNorm() - sphere.radius * sphere.radius);
  if (root <= 0) return std::nullopt;
  const Eigen::Vector3d point = ray * ((b - std::sqrt(root)) / a);
  return Hit{point, (point - sphere.center).normalized()};
}

// A square of 400 mm in the plane z = `depth`.
inline Mesh square_mesh(float depth) {
  return {.points = {{-200, -200, depth}, {200, -200, depth}, {200, 200, depth}, {-200, 200, depth}},
          .colors = {},
          .faces = {{0, 2, 1}, {0, 3, 2}}};
}

// The truth of a scene in which every pixel that meets something is reachable.
inline Truth make_truth(const RayCaster& cast, Mesh surface) {
  Calibration calibration;
  calibration.camera = small_camera();
  const Size size = calibration.camera.size;
  Expected<TrueSurface> exact = TrueSurface::build(std::move(surface));
  if (!exact) throw std::runtime_error(exact.error().message);
  Truth truth{calibration,
              FloatImage(size, 0.F),
              Image<Point3f>(size),
              GrayImage8(size, std::uint8_t{0}),
              {},
              std::move(*exact),
              {}};
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const std::optional<Hit> hit = cast(calibration.camera.ray({x, y}));
      if (!hit) continue;
      const Eigen::Vector3f normal = hit->normal.cast<float>();
      truth.depth(x, y) = static_cast<float>(hit->point.z());
      truth.normals(x, y) = {normal.x(), normal.y(), normal.z()};
      truth.reachable(x, y) = 255;
    }
  }
  place_points(truth);
  return truth;
}

inline Truth make_wall(float depth) {
  const Plane plane{-Eigen::Vector3d::UnitZ(), -depth};
  Truth truth =
      make_truth([=](const Eigen::Vector3d& ray) { return hit_plane(plane, ray); }, square_mesh(depth));
  truth.facts.planes.push_back({"wall", plane});
  return truth;
}

// One point a pixel of the truth, moved along the pixel's normal by `height(true point)` towards the camera.
inline std::vector<Point3f> displaced(const Truth& truth,
                                      const std::function<double(const Eigen::Vector3d&)>& height) {
  std::vector<Point3f> points;
  for (std::size_t i = 0; i < truth.points.size().area(); ++i) {
    const Point3f& at = truth.points.data()[i];
    if (at.z == 0) continue;
    const Point3f& normal = truth.normals.data()[i];
    const auto by = static_cast<float>(height({at.x, at.y, at.z}));
    points.push_back({at.x + by * normal.x, at.y + by * normal.y, at.z + by * normal.z});
  }
  return points;
}

}  // namespace bodyscan
