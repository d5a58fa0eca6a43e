#include "pipeline/surface/grid_mesh.hpp"

#include "pipeline/surface/surface.hpp"
#include "tests/pipeline/surface/scenes.hpp"

#include <array>
#include <map>
#include <set>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace bodyscan {
namespace {

GridMesh build(PointGrid grid, const Lens& lens) {
  SurfaceReport report;
  SurfaceOptions options;
  options.components.min_component_mm2 = 0;
  return build_surface(std::move(grid), lens, options, report).value();
}

double dome(const Lens& lens, int x, int y) {
  const double r = std::hypot(x - lens.cx, y - lens.cy) / 70;
  return r < 1 ? 1100 - 40 * std::sqrt(1 - r * r * 0.9) : double{scenes::none};
}

TEST(GridMesh, NumbersVerticesInRasterOrder) {
  const Lens lens = scenes::camera();
  const GridMesh mesh = build(scenes::grid(lens, [&](int x, int y) { return dome(lens, x, y); }), lens);
  const Mesh whole = mesh.to_mesh();
  ASSERT_EQ(whole.points.size(), mesh.point_count());
  ASSERT_EQ(whole.faces.size(), mesh.face_count());
  std::size_t number = 0;
  for (int y = 0; y < lens.size.height; ++y) {
    for (int x = 0; x < lens.size.width; ++x) {
      if (mesh.has(x, y)) {
        ASSERT_EQ(whole.points[number++], mesh.grid().points(x, y));
      }
    }
  }
  EXPECT_EQ(number, whole.points.size());
  EXPECT_GT(number, 10000U);
}

TEST(GridMesh, UsesEveryVertexAndNoneTwiceInAFace) {
  const Lens lens = scenes::camera();
  scenes::Noise noise(1);
  const auto holes = [&](int x, int y) { return noise() > 1 ? double{scenes::none} : dome(lens, x, y); };
  const Mesh mesh = build(scenes::grid(lens, holes), lens).to_mesh();
  std::vector<bool> used(mesh.points.size());
  for (const Face& face : mesh.faces) {
    for (const std::uint32_t index : face) {
      ASSERT_LT(index, mesh.points.size());
      used[index] = true;
    }
    EXPECT_TRUE(face[0] != face[1] && face[1] != face[2] && face[2] != face[0]);
  }
  EXPECT_EQ(std::ranges::count(used, false), 0);
}

TEST(GridMesh, NeighboursShareAnEdgeInOppositeDirections) {
  const Lens lens = scenes::camera();
  scenes::Noise noise(1);
  const auto holes = [&](int x, int y) { return noise() > 1.5 ? double{scenes::none} : dome(lens, x, y); };
  const Mesh mesh = build(scenes::grid(lens, holes), lens).to_mesh();
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const Face& face : mesh.faces) {
    for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(edges.insert({face[i], face[(i + 1) % 3]}).second);
  }
}

// FORMATS.md: the model's Transform turns the camera frame by pi about x into VRML's (y up, camera looks
// along -z).
TEST(GridMesh, FacesAreCounterClockwiseSeenFromTheCameraInVrml) {
  const Lens lens = scenes::camera();
  scenes::Noise noise(1);
  const auto holes = [&](int x, int y) { return noise() > 1 ? double{scenes::none} : dome(lens, x, y); };
  const Mesh mesh = build(scenes::grid(lens, holes), lens).to_mesh();
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(3.14159265, Eigen::Vector3d::UnitX()).toRotationMatrix();
  ASSERT_GT(mesh.faces.size(), 1000U);
  for (const Face& face : mesh.faces) {
    std::array<Eigen::Vector3d, 3> p;
    for (std::size_t i = 0; i < 3; ++i) {
      const Point3f& point = mesh.points[face[i]];
      p[i] = turn * Eigen::Vector3d(point.x, point.y, point.z) * 0.001;
    }
    // On the screen (x right, y up) of a camera at the origin, the signed area is positive.
    const auto screen = [](const Eigen::Vector3d& v) {
      return Eigen::Vector2d(v.x() / -v.z(), v.y() / -v.z());
    };
    const Eigen::Vector2d u = screen(p[1]) - screen(p[0]);
    const Eigen::Vector2d v = screen(p[2]) - screen(p[0]);
    ASSERT_GT(u.x() * v.y() - u.y() * v.x(), 0);
    // By the right-hand rule the normal points to the camera.
    ASSERT_LT((p[1] - p[0]).cross(p[2] - p[0]).dot(p[0]), 0);
  }
}

TEST(GridMesh, ChunksCoverALargeMeshOnce) {
  const Lens lens = scenes::camera(1200, 900);
  const GridMesh mesh = build(scenes::grid(lens, [](int, int) { return 1000.0; }), lens);
  ASSERT_EQ(mesh.point_count(), lens.size.area());
  int chunks = 0;
  std::size_t points = 0;
  ASSERT_TRUE(mesh.for_each_points([&](std::span<const Point3f> chunk) -> Expected<void> {
    EXPECT_EQ(chunk[0], mesh.grid().points.data()[points]);
    points += chunk.size();
    ++chunks;
    return {};
  }));
  EXPECT_EQ(points, mesh.point_count());
  EXPECT_GT(chunks, 2);
  std::size_t faces = 0;
  std::uint32_t last = 0;
  ASSERT_TRUE(mesh.for_each_faces([&](std::span<const Face> chunk) -> Expected<void> {
    EXPECT_GE(chunk[0][0], last);
    last = chunk.back()[0];
    faces += chunk.size();
    return {};
  }));
  EXPECT_EQ(faces, 2U * 1199U * 899U);
}

TEST(GridMesh, AnErrorEndsTheIteration) {
  const Lens lens = scenes::camera(1200, 900);
  const GridMesh mesh = build(scenes::grid(lens, [](int, int) { return 1000.0; }), lens);
  int calls = 0;
  const auto failing = [&](auto) -> Expected<void> {
    ++calls;
    return output_error("disk full");
  };
  EXPECT_EQ(mesh.for_each_points(failing).error().message, "disk full");
  EXPECT_EQ(mesh.for_each_faces(failing).error().message, "disk full");
  EXPECT_EQ(calls, 2);
}

TEST(GridMesh, AnEmptyGridIsAnEmptyMesh) {
  const Lens lens = scenes::camera();
  const GridMesh mesh = build(scenes::grid(lens, [](int, int) { return scenes::none; }), lens);
  EXPECT_EQ(mesh.point_count(), 0U);
  EXPECT_EQ(mesh.face_count(), 0U);
  EXPECT_EQ(mesh.mean_sigma_mm(), 0);
  EXPECT_TRUE(mesh.to_mesh().points.empty());
  EXPECT_EQ(GridMesh().point_count(), 0U);
  EXPECT_TRUE(GridMesh().to_mesh().faces.empty());
}

TEST(GridMesh, MeanUncertaintyCountsVerticesOnly) {
  const Lens lens = scenes::camera();
  PointGrid grid = scenes::grid(lens, [](int x, int) { return x < 100 ? 1000.0 : double{scenes::none}; });
  for (int y = 0; y < lens.size.height; ++y) {
    for (int x = 0; x < lens.size.width; ++x)
      grid.sigma_mm(x, y) = x < 50 ? 0.02F : x < 100 ? 0.04F : scenes::none;
  }
  EXPECT_NEAR(build(std::move(grid), lens).mean_sigma_mm(), 0.03, 1e-6);
}

TEST(BuildSurface, AccountsForEveryPoint) {
  const Lens lens = scenes::camera();
  scenes::Noise noise(1);
  const auto depth = [&](int x, int y) {
    if (x > 150) return noise() > 0 ? 1000 + 20 * noise() : double{scenes::none};
    return x > 120 && y > 20 ? double{scenes::none} : 1000.0;
  };
  SurfaceReport report;
  const GridMesh mesh = build_surface(scenes::grid(lens, depth), lens, {}, report).value();
  EXPECT_GT(report.clean.isolated_points, 100U);
  EXPECT_EQ(report.artifacts_removed() + mesh.point_count(), report.clean.points);
}

TEST(BuildSurface, RefusesAGridOfAnotherSizeAndBadOptions) {
  SurfaceReport report;
  const auto flat = [](int, int) { return 1000.0; };
  EXPECT_EQ(
      build_surface(scenes::grid(scenes::camera(10, 10), flat), scenes::camera(), {}, report).error().message,
      "surface: the point grid is not of the camera's size");
  SurfaceOptions options;
  options.mesh.max_area = 0;
  const auto refused = build_surface(scenes::grid(scenes::camera(), flat), scenes::camera(), options, report);
  EXPECT_EQ(refused.error().kind, ErrorKind::usage);
}

}  // namespace
}  // namespace bodyscan
