#include "tools/simulator/subjects.hpp"

#include "tools/simulator/shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace bodyscan::simulator {
namespace {

using Eigen::Vector3d;

void turn(Subject& subject, const Eigen::Matrix3d& rotation, const Vector3d& translation) {
  for (Vector3d& point : subject.mesh.points) point = rotation * point + translation;
  for (Eigen::Vector3f& normal : subject.mesh.normals) normal = rotation.cast<float>() * normal;
  for (PlaneFact& plane : subject.facts.planes) {
    for (Vector3d& corner : plane.corners) corner = rotation * corner + translation;
    plane.normal = rotation * plane.normal;
  }
  for (SphereFact& sphere : subject.facts.spheres) sphere.center = rotation * sphere.center + translation;
  for (BumpFact& bump : subject.facts.bumps) {
    bump.center = rotation * bump.center + translation;
    bump.normal = rotation * bump.normal;
  }
}

Eigen::Matrix3d turned_by(double x_degrees, double y_degrees, double z_degrees) {
  const double radian = std::numbers::pi / 180;
  return (Eigen::AngleAxisd(z_degrees * radian, Vector3d::UnitZ()) *
          Eigen::AngleAxisd(y_degrees * radian, Vector3d::UnitY()) *
          Eigen::AngleAxisd(x_degrees * radian, Vector3d::UnitX()))
      .toRotationMatrix();
}

// The bump on its square patch of the plane z = 0, towards -z.
void append_bump(TriangleMesh& mesh, const BumpFact& bump) {
  // A chord of this length stays within 0.0005 mm of the sharpest curvature, height / 2 (2 pi / diameter)^2.
  const double curvature = 2 * std::pow(std::numbers::pi / bump.diameter, 2) * bump.height;
  const double step = std::min(0.25, std::sqrt(8 * 0.0005 / curvature));
  const Surface surface = [&](double u, double v) {
    const double r = std::min(0.5, std::hypot(u, v) / bump.diameter);
    return Vector3d(bump.center.x() + u, bump.center.y() + v,
                    -bump.height / 2 * (1 + std::cos(2 * std::numbers::pi * r)));
  };
  const std::vector<double> lines = even_steps(-bump.diameter / 2, bump.diameter / 2, step);
  append_surface(mesh, surface, lines, lines);
}

// The rest of a bump's square cell: four rectangles around its patch.
void append_frame(TriangleMesh& mesh, const Vector3d& center, double cell, double patch) {
  const double width = (cell - patch) / 4;  // half a rectangle's
  const double offset = (cell + patch) / 4;
  const Vector3d x = Vector3d::UnitX();
  const Vector3d y = Vector3d::UnitY();
  for (const double sign : {-1.0, 1.0}) {
    append_rectangle(mesh, center + sign * offset * y, cell / 2 * x, width * y);
    append_rectangle(mesh, center + sign * offset * x, width * x, patch / 2 * y);
  }
}

}  // namespace

Subject make_staircase() {
  Subject subject{.name = "staircase", .mesh = {}, .facts = {}, .material = Material::matt};
  constexpr double base = 80;  // the base's z; the block of 100 mm has its face at 1030 mm
  constexpr double width = 60;
  subject.facts.planes.push_back(
      append_box(subject.mesh, Vector3d(-190, -130, base), Vector3d(190, 130, base + 10)));
  subject.facts.planes.back().name = "base";
  double left = -2 * width;
  for (const int height : {100, 101, 103, 106}) {
    subject.facts.planes.push_back(
        append_box(subject.mesh, Vector3d(left, -75, base - height), Vector3d(left + width, 75, base)));
    subject.facts.planes.back().name = "step " + std::to_string(height);
    subject.facts.planes.back().height = height;
    left += width;
  }
  return subject;
}

Subject make_spheres() {
  Subject subject{.name = "spheres", .mesh = {}, .facts = {}, .material = Material::matt};
  subject.facts.planes.push_back(append_box(subject.mesh, Vector3d(-140, -95, 0), Vector3d(140, 95, 6)));
  subject.facts.planes.back().name = "plate";
  for (const Vector3d& center : {Vector3d(-68, -11, -34), Vector3d(71, 14, -34)}) {
    subject.facts.spheres.push_back({center, 30});
    append_sphere(subject.mesh, subject.facts.spheres.back(), 0.3);
  }
  turn(subject, turned_by(7, -9, 4), Vector3d(4, -3, 35));
  return subject;
}

Subject make_bumps() {
  Subject subject{.name = "bumps", .mesh = {}, .facts = {}, .material = Material::matt};
  constexpr std::array diameters{2.0, 3.0, 5.0, 8.0};
  constexpr std::array heights{0.1, 0.2, 0.5};
  constexpr double cell = 18;
  constexpr int columns = 12;
  constexpr int rows = 8;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const auto kind = static_cast<std::size_t>(i + 5 * j);
      const BumpFact bump{Vector3d((i - (columns - 1) / 2.0) * cell, (j - (rows - 1) / 2.0) * cell, 0),
                          -Vector3d::UnitZ(), diameters[kind % 4], heights[kind / 4 % 3]};
      append_frame(subject.mesh, bump.center, cell, bump.diameter);
      append_bump(subject.mesh, bump);
      subject.facts.bumps.push_back(bump);
    }
  }
  TriangleMesh outline;
  subject.facts.planes.push_back(append_rectangle(outline, Vector3d::Zero(),
                                                  columns * cell / 2 * Vector3d::UnitX(),
                                                  rows * cell / 2 * Vector3d::UnitY()));
  subject.facts.planes.back().name = "plate";
  turn(subject, turned_by(5, 8, 3), Vector3d(-3, 4, 0));
  return subject;
}

const std::string& builtin_subject_names() {
  static const std::string names = "staircase, spheres, bumps, head, torso, forearm";
  return names;
}

Expected<Subject> make_builtin_subject(const std::string& name, double detail) {
  if (name == "staircase") return make_staircase();
  if (name == "spheres") return make_spheres();
  if (name == "bumps") return make_bumps();
  if (name == "head") return make_head(detail);
  if (name == "torso") return make_torso(detail);
  if (name == "forearm") return make_forearm(detail);
  return tl::unexpected(Error{ErrorKind::usage, "--subject: no built-in \"" + name +
                                                    "\" (there are: " + builtin_subject_names() + ")"});
}

}  // namespace bodyscan::simulator
