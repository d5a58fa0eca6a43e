#pragma once

#include "tools/simulator/subject.hpp"

#include <functional>
#include <vector>

#include <Eigen/Core>

namespace bodyscan::simulator {

// A flat rectangle: corners center +- half_x +- half_y, normal half_y x half_x.
PlaneFact append_rectangle(TriangleMesh& mesh, const Eigen::Vector3d& center, const Eigen::Vector3d& half_x,
                           const Eigen::Vector3d& half_y);

// An axis-aligned box with hard edges; returns its front face (the one at the smallest z).
PlaneFact append_box(TriangleMesh& mesh, const Eigen::Vector3d& smallest, const Eigen::Vector3d& largest);

// A sphere of triangles whose legs are at most `step` mm long; the points lie on the sphere.
void append_sphere(TriangleMesh& mesh, const SphereFact& sphere, double step);

// The surface point at parameters (u, v). du x dv points inwards.
using Surface = std::function<Eigen::Vector3d(double u, double v)>;

// A surface over the grid of `us` x `vs`; the normals are the exact tangents' product by central differences.
void append_surface(TriangleMesh& mesh, const Surface& surface, const std::vector<double>& us,
                    const std::vector<double>& vs);

// From `first` to `last` in equal steps of at most `step`.
std::vector<double> even_steps(double first, double last, double step);

}  // namespace bodyscan::simulator
