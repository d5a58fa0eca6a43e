#pragma once

#include "pipeline/geometry/rigid_transform.hpp"

#include <optional>
#include <span>

#include <Eigen/Core>

namespace bodyscan {

// The homography with b ~ H a for pairs of points, by the normalised direct linear transform (Hartley 1997),
// `weights` (if any) on the pairs. Nothing for fewer than four pairs or points on a line.
std::optional<Eigen::Matrix3d> fit_homography(std::span<const Eigen::Vector2d> a,
                                              std::span<const Eigen::Vector2d> b,
                                              std::span<const double> weights = {});

Eigen::Vector2d apply_homography(const Eigen::Matrix3d& homography, const Eigen::Vector2d& point);

// The plane's pose for a homography from the plane's coordinates (mm) to ideal normalised image coordinates
// (Zhang 2000, section 3.1), the nearest rotation taken.
RigidTransform pose_of_plane(const Eigen::Matrix3d& homography);

}  // namespace bodyscan
