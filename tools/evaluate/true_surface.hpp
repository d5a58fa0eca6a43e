#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/model/mesh.hpp"

#include <memory>

#include <Eigen/Core>

namespace bodyscan {

// Exact distances to a triangle mesh (mm, camera frame), by Embree's point queries. Safe to ask from any
// thread.
class TrueSurface {
 public:
  static Expected<TrueSurface> build(Mesh mesh);
  TrueSurface(TrueSurface&&) noexcept;
  TrueSurface& operator=(TrueSurface&&) noexcept;
  ~TrueSurface();

  // Distance from `point` to the closest triangle, negative where the point lies behind it as seen from the
  // origin (the camera). Nothing farther than `at_most` is looked at: then infinity.
  [[nodiscard]] double signed_distance(const Eigen::Vector3d& point, double at_most) const;

 private:
  struct Scene;
  explicit TrueSurface(std::unique_ptr<Scene> scene);
  std::unique_ptr<Scene> scene_;
};

}  // namespace bodyscan
