#include "pipeline/board/homography.hpp"

#include <cmath>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/SVD>

namespace bodyscan {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

// Moves the points' mean to the origin and their mean distance from it to sqrt(2).
std::optional<Matrix3d> normalisation(std::span<const Vector2d> points) {
  Vector2d mean = Vector2d::Zero();
  for (const Vector2d& point : points) mean += point / static_cast<double>(points.size());
  double distance = 0;
  for (const Vector2d& point : points) distance += (point - mean).norm() / static_cast<double>(points.size());
  if (!(distance > 0)) return std::nullopt;
  const double scale = std::sqrt(2.0) / distance;
  Matrix3d matrix = Matrix3d::Identity();
  matrix.topLeftCorner<2, 2>() *= scale;
  matrix.topRightCorner<2, 1>() = -scale * mean;
  return matrix;
}

}  // namespace

Vector2d apply_homography(const Matrix3d& homography, const Vector2d& point) {
  return (homography * point.homogeneous()).hnormalized();
}

std::optional<Matrix3d> fit_homography(std::span<const Vector2d> a, std::span<const Vector2d> b,
                                       std::span<const double> weights) {
  if (a.size() < 4 || a.size() != b.size()) return std::nullopt;
  const auto from_a = normalisation(a);
  const auto from_b = normalisation(b);
  if (!from_a || !from_b) return std::nullopt;
  Eigen::Matrix<double, 9, 9> normal = Eigen::Matrix<double, 9, 9>::Zero();
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Eigen::Vector3d p = *from_a * a[i].homogeneous();
    const Vector2d q = (*from_b * b[i].homogeneous()).head<2>();
    Eigen::Matrix<double, 2, 9> rows = Eigen::Matrix<double, 2, 9>::Zero();
    rows.block<1, 3>(0, 0) = p.transpose();
    rows.block<1, 3>(0, 6) = -q.x() * p.transpose();
    rows.block<1, 3>(1, 3) = p.transpose();
    rows.block<1, 3>(1, 6) = -q.y() * p.transpose();
    normal += (weights.empty() ? 1.0 : weights[i]) * rows.transpose() * rows;
  }
  const Eigen::JacobiSVD<Eigen::Matrix<double, 9, 9>> svd(normal, Eigen::ComputeFullV);
  // A second vanishing direction: the points do not determine the homography.
  if (svd.singularValues()[7] < 1e-12 * svd.singularValues()[0]) return std::nullopt;
  const Eigen::Matrix<double, 9, 1> solution = svd.matrixV().col(8);
  Matrix3d homography;
  homography << solution[0], solution[1], solution[2], solution[3], solution[4], solution[5], solution[6],
      solution[7], solution[8];
  return Matrix3d(from_b->inverse() * homography * *from_a);
}

RigidTransform pose_of_plane(const Matrix3d& homography) {
  const double scale = 2 / (homography.col(0).norm() + homography.col(1).norm());
  const double sign = homography(2, 2) < 0 ? -1 : 1;  // in front
  const Matrix3d scaled = sign * scale * homography;
  Matrix3d axes;
  axes << scaled.col(0), scaled.col(1), scaled.col(0).cross(scaled.col(1));
  const Eigen::JacobiSVD<Matrix3d> svd(axes, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3d rotation = svd.matrixU() * svd.matrixV().transpose();
  if (rotation.determinant() < 0) rotation.col(2) *= -1;
  return {rotation, scaled.col(2)};
}

}  // namespace bodyscan
