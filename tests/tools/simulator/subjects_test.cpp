#include "tools/simulator/subjects.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace bodyscan::simulator {
namespace {

using Eigen::Vector3d;

TEST(Subjects, StaircaseHasTheThesisHeights) {
  const Subject subject = make_staircase();
  const std::vector<PlaneFact>& planes = subject.facts.planes;
  ASSERT_EQ(planes.size(), 5U);
  const std::array heights{0.0, 100.0, 101.0, 103.0, 106.0};
  for (std::size_t i = 0; i < planes.size(); ++i) {
    EXPECT_EQ(planes[i].height, heights[i]);
    for (const Vector3d& corner : planes[i].corners)
      EXPECT_EQ(corner.z(), planes[0].corners[0].z() - heights[i]);
    EXPECT_LT((planes[i].normal + Vector3d::UnitZ()).norm(), 1e-12);
  }
}

TEST(Subjects, SpheresFollowTheirFacts) {
  const Subject subject = make_spheres();
  const TriangleMesh& mesh = subject.mesh;
  ASSERT_EQ(subject.facts.spheres.size(), 2U);
  std::size_t on_spheres = 0;
  for (const Triangle& triangle : mesh.triangles) {
    const Vector3d middle =
        (mesh.points[triangle[0]] + mesh.points[triangle[1]] + mesh.points[triangle[2]]) / 3;
    for (const SphereFact& sphere : subject.facts.spheres) {
      const double distance = (middle - sphere.center).norm();
      if (distance > 31) continue;
      ++on_spheres;
      EXPECT_NEAR(distance, sphere.radius, 0.001);
    }
  }
  EXPECT_GT(on_spheres, 100000U);
}

TEST(Subjects, BumpsFollowTheRaisedCosine) {
  const Subject subject = make_bumps();
  const TriangleMesh& mesh = subject.mesh;
  std::map<std::pair<double, double>, int> kinds;
  for (const BumpFact& bump : subject.facts.bumps) ++kinds[{bump.diameter, bump.height}];
  EXPECT_EQ(kinds.size(), 12U);
  for (const auto& [kind, count] : kinds) EXPECT_GE(count, 4);

  double worst = 0;
  double highest = 0;
  for (const Triangle& triangle : mesh.triangles) {
    const Vector3d middle =
        (mesh.points[triangle[0]] + mesh.points[triangle[1]] + mesh.points[triangle[2]]) / 3;
    for (const BumpFact& bump : subject.facts.bumps) {
      const Vector3d from_foot = middle - bump.center;
      const double height = from_foot.dot(bump.normal);
      const double r = (from_foot - height * bump.normal).norm();
      if (r > bump.diameter / 2) continue;
      const double wanted = bump.height / 2 * (1 + std::cos(2 * std::numbers::pi * r / bump.diameter));
      worst = std::max(worst, std::abs(height - wanted));
      highest = std::max(highest, height);
    }
  }
  EXPECT_LT(worst, 0.001);
  EXPECT_NEAR(highest, 0.5, 0.005);
}

TEST(Subjects, TrianglesFaceOutwardsAsTheirNormalsDo) {
  for (const char* name : {"staircase", "spheres", "bumps", "head", "torso", "forearm"}) {
    const Subject subject = make_builtin_subject(name, 4).value();
    const TriangleMesh& mesh = subject.mesh;
    ASSERT_EQ(mesh.points.size(), mesh.normals.size());
    std::size_t wrong = 0;
    Vector3d area = Vector3d::Zero();
    double front = 0;
    for (const Triangle& triangle : mesh.triangles) {
      const Vector3d& a = mesh.points[triangle[0]];
      const Vector3d cross = (mesh.points[triangle[1]] - a).cross(mesh.points[triangle[2]] - a);
      const Vector3d normal = mesh.normals[triangle[0]].cast<double>();
      if (cross.norm() > 1e-3 && cross.normalized().dot(normal) < 0) ++wrong;
      area += cross / 2;
      if (cross.z() < 0) front -= cross.z() / 2;
    }
    EXPECT_LT(static_cast<double>(wrong), 0.01 * static_cast<double>(mesh.triangles.size())) << name;
    EXPECT_GT(front, 10000) << name;  // mm^2 towards the camera
  }
}

TEST(Subjects, BodyPartsHaveMolesOnTheirSurface) {
  for (const char* name : {"head", "torso", "forearm"}) {
    const Subject subject = make_builtin_subject(name, 2).value();
    EXPECT_EQ(subject.material, Material::skin);
    EXPECT_GE(subject.facts.moles.size(), 8U) << name;
    for (const MoleFact& mole : subject.facts.moles) {
      double nearest = 1e9;
      for (const Vector3d& point : subject.mesh.points)
        nearest = std::min(nearest, (point - mole.center).norm());
      EXPECT_LT(nearest, 2) << name;
    }
  }
}

TEST(Subjects, DetailSetsTheTrianglesSize) {
  EXPECT_GT(make_torso(1).mesh.triangles.size(), 3 * make_torso(2).mesh.triangles.size());
}

TEST(Subjects, AnUnknownNameIsRefusedWithTheNamesThereAre) {
  const Expected<Subject> subject = make_builtin_subject("cube", 1);
  ASSERT_FALSE(subject);
  EXPECT_EQ(subject.error().kind, ErrorKind::usage);
  EXPECT_NE(subject.error().message.find("staircase, spheres"), std::string::npos);
}

}  // namespace
}  // namespace bodyscan::simulator
