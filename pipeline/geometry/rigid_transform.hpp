#pragma once

#include <Eigen/Core>

namespace bodyscan {

struct RigidTransform {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  // mm

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const { return rotation * point + translation; }
  // c_from_b * b_from_a is c_from_a.
  RigidTransform operator*(const RigidTransform& before) const {
    return {rotation * before.rotation, *this * before.translation};
  }
  [[nodiscard]] RigidTransform inverse() const {
    return {rotation.transpose(), -(rotation.transpose() * translation)};
  }
};

}  // namespace bodyscan
