#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/base/image.hpp"
#include "pipeline/geometry/calibration.hpp"
#include "pipeline/geometry/point_grid.hpp"
#include "tools/evaluate/shape_fit.hpp"
#include "tools/evaluate/true_surface.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace bodyscan {

// Shapes of a scene that are known exactly; camera frame, mm.
struct NamedPlane {
  std::string name;
  Plane plane;
};
struct Bump {
  Eigen::Vector3d center;  // on the base plane
  double diameter = 0;
  double height = 0;
};
struct Mole {
  Eigen::Vector3d center;
  double diameter = 0;
};
struct SceneFacts {
  std::vector<NamedPlane> planes;
  std::vector<NamedPlane> steps;  // of a staircase, in order
  std::vector<Sphere> spheres;
  std::vector<Bump> bumps;  // on planes[0]
  std::vector<Mole> moles;
};

// What the simulator knows about a capture. Pixels without a surface have depth 0.
struct Truth {
  Calibration calibration;
  FloatImage depth;        // mm, z at the ray of the pixel's centre
  Image<Point3f> normals;  // unit, towards the camera
  GrayImage8 reachable;    // 255 where camera and projector both see the surface, else 0
  Image<Point3f> points;   // depth along the ray; z is 0 where there is none
  TrueSurface surface;
  SceneFacts facts;

  [[nodiscard]] bool has(int x, int y) const { return depth(x, y) > 0; }
};

// Fills `points` from the depth and the camera's lens.
void place_points(Truth& truth);

// Reads CAPTURE_DIR/calibration.yml and what lies in CAPTURE_DIR/truth/.
Expected<Truth> read_truth(const std::filesystem::path& capture_dir);

}  // namespace bodyscan
