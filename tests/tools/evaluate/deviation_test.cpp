#include "tools/evaluate/deviation.hpp"

#include "tests/tools/evaluate/scenes.hpp"

#include <cmath>

namespace bodyscan {
namespace {

using Eigen::Vector3d;

TEST(TrueSurface, SignedDistanceToFaceEdgeAndCorner) {
  const TrueSurface surface = TrueSurface::build(square_mesh(1000)).value();
  constexpr double far = 1e9;
  EXPECT_NEAR(surface.signed_distance(Vector3d(10, 20, 990), far), 10, 1e-9);
  EXPECT_NEAR(surface.signed_distance(Vector3d(10, 20, 1010), far), -10, 1e-9);
  EXPECT_NEAR(surface.signed_distance(Vector3d(203, 0, 996), far), 5, 1e-9);
  EXPECT_NEAR(surface.signed_distance(Vector3d(201, 202, 998), far), 3, 1e-9);
  EXPECT_NEAR(surface.signed_distance(Vector3d(0, 0, 999.9999), far), 1e-4, 1e-9);
}

TEST(TrueSurface, LooksNoFartherThanAsked) {
  const TrueSurface surface = TrueSurface::build(square_mesh(1000)).value();
  EXPECT_TRUE(std::isinf(surface.signed_distance(Vector3d(0, 0, 900), 99)));
  EXPECT_NEAR(surface.signed_distance(Vector3d(0, 0, 900), 101), 100, 1e-9);
}

TEST(TrueSurface, RefusesAMeshWithoutFaces) {
  EXPECT_FALSE(TrueSurface::build(Mesh{}));
}

TEST(Deviations, AreSignedTowardsTheCamera) {
  const Truth wall = make_wall(1000);
  const std::vector<Point3f> points{
      {0, 0, 1000}, {5, 5, 999.9F}, {5, 5, 1000.15F}, {-9, 3, 997}, {-9, 3, 1004}};
  const Deviations deviations = measure_deviations(wall, points);
  const std::vector<double> expected{0, 0.1, -0.15, 3, -4};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(deviations.distance[i], expected[i], 1e-4) << i;
  }
}

TEST(Deviations, PointsOutsideThePictureCountToo) {
  const Truth wall = make_wall(1000);
  const std::vector<Point3f> points{{195, 0, 998}, {0, 0, -50}, {0, 0, 1000}};
  const Deviations deviations = measure_deviations(wall, points);
  EXPECT_EQ(deviations.pixel[0], -1);
  EXPECT_NEAR(deviations.distance[0], 2, 1e-6);
  EXPECT_EQ(deviations.pixel[1], -1);
  EXPECT_NEAR(deviations.distance[1], 1050, 1e-3);
  EXPECT_NEAR(share_wrong(deviations), 2.0 / 3, 1e-9);
}

// On a sphere the tangent plane of the pixel would be wrong for a point far from the surface.
TEST(Deviations, FarFromACurvedSurfaceTheyAreExact) {
  const Sphere sphere{Vector3d(0, 0, 1000), 60};
  Mesh mesh;
  constexpr int lines = 400;
  for (int i = 0; i <= lines; ++i) {
    for (int j = 0; j <= lines; ++j) {
      const double x = (i * 2.0 / lines - 1) * 40;
      const double y = (j * 2.0 / lines - 1) * 40;
      const double z = 1000 - std::sqrt(60 * 60 - x * x - y * y);
      mesh.points.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
      if (i == lines || j == lines) continue;
      const auto corner = static_cast<std::uint32_t>(i * (lines + 1) + j);
      mesh.faces.push_back({corner, corner + 1, corner + lines + 1});
      mesh.faces.push_back({corner + 1, corner + lines + 2, corner + lines + 1});
    }
  }
  const Truth truth =
      make_truth([&](const Vector3d& ray) { return hit_sphere(sphere, ray); }, std::move(mesh));
  const Vector3d away = Vector3d(0.45, 0.2, -1).normalized();
  std::vector<Point3f> points;
  for (const double height : {0.05, 0.5, 2.0, -0.5}) {
    const Eigen::Vector3f point = (sphere.center + away * (sphere.radius + height)).cast<float>();
    points.push_back({point.x(), point.y(), point.z()});
  }
  const Deviations deviations = measure_deviations(truth, points);
  EXPECT_NEAR(deviations.distance[0], 0.05, 0.02);  // by the tangent plane, at up to half a pixel's distance
  EXPECT_NEAR(deviations.distance[1], 0.5, 5e-4);
  EXPECT_NEAR(deviations.distance[2], 2.0, 5e-4);
  EXPECT_NEAR(deviations.distance[3], -0.5, 5e-4);
}

TEST(Coverage, CountsReachablePixelsThatHaveAPointWithinAMillimetre) {
  Truth wall = make_wall(1000);
  const std::size_t pixels = wall.depth.size().area();
  for (int x = 0; x < wall.depth.width(); ++x) wall.reachable(x, 0) = 0;
  std::vector<Point3f> points = displaced(wall, [](const Vector3d&) { return 0.3; });
  const auto reachable = pixels - static_cast<std::size_t>(wall.depth.width());
  const Coverage whole = measure_coverage(wall, measure_deviations(wall, points));
  EXPECT_EQ(whole.reachable, reachable);
  EXPECT_EQ(whole.covered, reachable);

  points[pixels - 1].z -= 2;  // too far off
  points.erase(points.end() - 3);
  const Coverage holed = measure_coverage(wall, measure_deviations(wall, points));
  EXPECT_EQ(holed.covered, reachable - 2);
  EXPECT_NEAR(holed.completeness(), 1 - 2.0 / static_cast<double>(reachable), 1e-12);
}

}  // namespace
}  // namespace bodyscan
