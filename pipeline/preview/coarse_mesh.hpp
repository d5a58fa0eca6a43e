#pragma once

#include "pipeline/model/mesh.hpp"
#include "pipeline/surface/color.hpp"
#include "pipeline/surface/grid_mesh.hpp"

#include <vector>

#include <Eigen/Core>

namespace bodyscan {

struct CoarseVertex {
  Eigen::Vector3f position;  // mm, camera frame
  Eigen::Vector3f normal;    // unit, towards the camera
  Eigen::Vector3f color;     // linear light, 0..1
};

struct CoarseMesh {
  std::vector<CoarseVertex> vertices;
  std::vector<Face> faces;
};

// A mesh on every `step`-th pixel: a vertex is the mean of those of the full mesh in a block of step x step
// that lie at about the depth of the one nearest to its middle; light grey without `colors`.
[[nodiscard]] CoarseMesh coarse_mesh(const GridMesh& mesh, const SurfaceColor* colors, int step);

}  // namespace bodyscan
