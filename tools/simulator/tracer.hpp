#pragma once

#include "pipeline/base/error.hpp"
#include "tools/simulator/scene.hpp"

#include <memory>
#include <optional>

#include <Eigen/Core>

namespace bodyscan::simulator {

// Where a camera ray meets the subject; camera frame, mm.
struct SurfaceHit {
  Eigen::Vector3d point;
  Eigen::Vector3d face_normal;  // of the triangle, unit length, towards the camera
  Eigen::Vector3d normal;       // interpolated between the vertices, unit length
  Eigen::Vector3f albedo;       // linear RGB
};

// How the projector sees a surface point.
struct Illumination {
  double row = 0;  // projector px
  double column = 0;
  double cosine = 0;    // of the incidence, by the interpolated normal
  double distance = 0;  // mm
  bool in_picture = false;
  bool direct = false;  // in the picture, facing the projector and not in shadow
};

// Casts rays at a scene (Embree 3). Safe to call from several threads.
class Tracer {
 public:
  // `scene` must outlive the tracer.
  static Expected<Tracer> make(const Scene& scene);

  // The ray from the camera along `direction` (z = 1) to the subject moved by `offset` mm. Triangles are
  // found in single precision, points computed in double.
  [[nodiscard]] std::optional<SurfaceHit> hit(const Eigen::Vector3d& direction,
                                              const Eigen::Vector3d& offset) const;
  [[nodiscard]] Illumination illumination(const SurfaceHit& hit, const Eigen::Vector3d& offset) const;

 private:
  struct Embree;
  explicit Tracer(const Scene& scene);
  [[nodiscard]] Eigen::Vector3f albedo(unsigned triangle, const Eigen::Vector3d& weights,
                                       const Eigen::Vector3d& point) const;
  [[nodiscard]] bool occluded(const Eigen::Vector3d& point, const Eigen::Vector3d& target) const;

  const Scene* scene_;
  std::shared_ptr<Embree> embree_;
  Eigen::Vector3d projector_center_;
  double largest_tangent2_ = 0;  // squared radius of the picture's ideal image, with a margin
};

}  // namespace bodyscan::simulator
