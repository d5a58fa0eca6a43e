#include "tools/simulator/shapes.hpp"

#include "pipeline/base/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace bodyscan::simulator {
namespace {

std::uint32_t next_index(const TriangleMesh& mesh) {
  return static_cast<std::uint32_t>(mesh.points.size());
}

// Triangles of a grid of columns x rows points, row-major from `first`.
void append_grid_triangles(TriangleMesh& mesh, std::uint32_t first, std::size_t columns, std::size_t rows) {
  mesh.triangles.reserve(mesh.triangles.size() + 2 * (columns - 1) * (rows - 1));
  for (std::size_t j = 0; j + 1 < rows; ++j) {
    for (std::size_t i = 0; i + 1 < columns; ++i) {
      const auto a = first + static_cast<std::uint32_t>(j * columns + i);
      const auto c = a + static_cast<std::uint32_t>(columns);
      mesh.triangles.push_back({a, c, c + 1});
      mesh.triangles.push_back({a, c + 1, a + 1});
    }
  }
}

}  // namespace

PlaneFact append_rectangle(TriangleMesh& mesh, const Eigen::Vector3d& center, const Eigen::Vector3d& half_x,
                           const Eigen::Vector3d& half_y) {
  PlaneFact plane;
  plane.corners = {center - half_x - half_y, center - half_x + half_y, center + half_x + half_y,
                   center + half_x - half_y};
  plane.normal = half_y.cross(half_x).normalized();
  const std::uint32_t first = next_index(mesh);
  for (const Eigen::Vector3d& corner : plane.corners) {
    mesh.points.push_back(corner);
    mesh.normals.emplace_back(plane.normal.cast<float>());
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
  return plane;
}

PlaneFact append_box(TriangleMesh& mesh, const Eigen::Vector3d& smallest, const Eigen::Vector3d& largest) {
  const Eigen::Vector3d center = (smallest + largest) / 2;
  const Eigen::Vector3d half = (largest - smallest) / 2;
  const auto side = [&](int axis, double sign) {
    Eigen::Vector3d out = Eigen::Vector3d::Zero();
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    out[axis] = sign * half[axis];
    x[(axis + 1) % 3] = half[(axis + 1) % 3];
    const Eigen::Vector3d y_unit = x.cross(out).normalized();
    return append_rectangle(mesh, center + out, x, y_unit * half[(axis + 2) % 3]);
  };
  for (int axis = 0; axis < 2; ++axis) {
    side(axis, -1);
    side(axis, 1);
  }
  side(2, 1);
  return side(2, -1);
}

void append_sphere(TriangleMesh& mesh, const SphereFact& sphere, double step) {
  using std::numbers::pi;
  const double angle = step / sphere.radius;
  const Surface surface = [&](double u, double v) -> Eigen::Vector3d {
    return sphere.center + sphere.radius * Eigen::Vector3d(std::sin(v) * std::cos(u), -std::cos(v),
                                                           -std::sin(v) * std::sin(u));
  };
  const std::size_t first = mesh.points.size();
  append_surface(mesh, surface, even_steps(2 * pi, 0, angle), even_steps(0, pi, angle));
  for (std::size_t i = first; i < mesh.points.size(); ++i)
    mesh.normals[i] = ((mesh.points[i] - sphere.center) / sphere.radius).cast<float>();
}

void append_surface(TriangleMesh& mesh, const Surface& surface, const std::vector<double>& us,
                    const std::vector<double>& vs) {
  const std::uint32_t first = next_index(mesh);
  mesh.points.resize(first + us.size() * vs.size());
  mesh.normals.resize(mesh.points.size());
  const double du = std::abs(us.back() - us.front()) * 1e-6;
  const double dv = std::abs(vs.back() - vs.front()) * 1e-6;
  const double u_sign = us.back() > us.front() ? 1 : -1;
  parallel_for(0, static_cast<int>(vs.size()), 8, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      const double v = vs[static_cast<std::size_t>(j)];
      for (std::size_t i = 0; i < us.size(); ++i) {
        const std::size_t index = first + static_cast<std::size_t>(j) * us.size() + i;
        mesh.points[index] = surface(us[i], v);
        const Eigen::Vector3d along_u = surface(us[i] + du, v) - surface(us[i] - du, v);
        const Eigen::Vector3d along_v = surface(us[i], v + dv) - surface(us[i], v - dv);
        mesh.normals[index] = (u_sign * along_v.cross(along_u)).stableNormalized().cast<float>();
      }
    }
  });
  append_grid_triangles(mesh, first, us.size(), vs.size());
}

std::vector<double> even_steps(double first, double last, double step) {
  const int count = std::max(1, static_cast<int>(std::ceil(std::abs(last - first) / step)));
  std::vector<double> values;
  for (int i = 0; i <= count; ++i) values.push_back(first + (last - first) * i / count);
  return values;
}

}  // namespace bodyscan::simulator
