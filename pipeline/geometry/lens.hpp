#pragma once

#include "pipeline/base/image.hpp"

#include <array>

#include <Eigen/Core>

namespace bodyscan {

// A pinhole with OpenCV's radial and tangential distortion (Brown 1966), for camera and projector alike.
struct Lens {
  Size size;
  double fx = 0;  // px
  double fy = 0;
  double cx = 0;  // px, pixel centres at integers
  double cy = 0;
  std::array<double, 5> distortion{};  // k1 k2 p1 p2 k3

  // Ideal to distorted normalised coordinates (x/z, y/z).
  [[nodiscard]] Eigen::Vector2d distort(const Eigen::Vector2d& ideal) const;
  // The inverse, by Newton's method; exact to 1e-12 wherever the distortion is invertible.
  [[nodiscard]] Eigen::Vector2d undistort(const Eigen::Vector2d& distorted) const;
  // A point in the lens's frame (mm, z > 0) to pixels.
  [[nodiscard]] Eigen::Vector2d project(const Eigen::Vector3d& point) const;
  // The ray (x/z, y/z, 1) seen at a pixel.
  [[nodiscard]] Eigen::Vector3d ray(const Eigen::Vector2d& pixel) const;
};

}  // namespace bodyscan
