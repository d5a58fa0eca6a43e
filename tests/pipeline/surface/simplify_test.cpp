#include "pipeline/surface/simplify.hpp"

#include "pipeline/surface/surface.hpp"
#include "tests/pipeline/surface/scenes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace bodyscan {
namespace {

using Eigen::Vector3d;

Vector3d vector(const Point3f& p) {
  return {p.x, p.y, p.z};
}

// Ericson 2005, Real-Time Collision Detection, 5.1.5.
double distance_to_triangle(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const auto to_segment = [&](const Vector3d& u, const Vector3d& v) {
    const double t = std::clamp((p - u).dot(v - u) / (v - u).squaredNorm(), 0.0, 1.0);
    return (p - u - t * (v - u)).norm();
  };
  const Vector3d normal = (b - a).cross(c - a).normalized();
  const auto left_of = [&](const Vector3d& u, const Vector3d& v) {
    return (v - u).cross(p - u).dot(normal) >= 0;
  };
  if (left_of(a, b) && left_of(b, c) && left_of(c, a)) return std::abs(normal.dot(p - a));
  return std::min({to_segment(a, b), to_segment(b, c), to_segment(c, a)});
}

// The largest distance of the points to the mesh; triangles are looked for around each point's pixel.
double largest_distance(const std::vector<Point3f>& points, const Mesh& mesh, const Lens& lens) {
  constexpr int bin = 16;
  const int columns = lens.size.width / bin + 1;
  std::vector<std::vector<std::size_t>> bins(
      static_cast<std::size_t>(columns * (lens.size.height / bin + 1)));
  const auto bin_of = [&](const Point3f& point) {
    const Eigen::Vector2d pixel = lens.project(vector(point)) / bin;
    return std::array{std::clamp(static_cast<int>(std::floor(pixel.x())), 0, columns - 1),
                      std::clamp(static_cast<int>(std::floor(pixel.y())), 0, lens.size.height / bin)};
  };
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    std::array<int, 2> low{1 << 20, 1 << 20};
    std::array<int, 2> high{0, 0};
    for (const std::uint32_t index : mesh.faces[i]) {
      const auto at = bin_of(mesh.points[index]);
      for (std::size_t k = 0; k < 2; ++k) {
        low[k] = std::min(low[k], at[k]);
        high[k] = std::max(high[k], at[k]);
      }
    }
    for (int y = low[1]; y <= high[1]; ++y) {
      for (int x = low[0]; x <= high[0]; ++x) bins[static_cast<std::size_t>(y * columns + x)].push_back(i);
    }
  }
  double largest = 0;
  for (const Point3f& point : points) {
    const auto at = bin_of(point);
    double nearest = 1e9;
    for (const std::size_t i : bins[static_cast<std::size_t>(at[1] * columns + at[0])]) {
      const auto [p, q, r] = mesh.faces[i];
      nearest = std::min(nearest, distance_to_triangle(vector(point), vector(mesh.points[p]),
                                                       vector(mesh.points[q]), vector(mesh.points[r])));
    }
    largest = std::max(largest, nearest);
  }
  return largest;
}

// A body-like surface, 0.33 mm a pixel: a forearm with wrinkles before nothing.
Lens half_size_camera() {
  Lens lens = scenes::camera(420, 340);
  lens.fx = lens.fy = 3180;
  return lens;
}

double forearm(const Lens& lens, int x, int y) {
  const double u = (x - lens.cx) / 3180 * 1000;
  const double v = (y - lens.cy) / 3180 * 1000;
  const double r = (v - 0.1 * u) / 60;
  if (std::abs(r) > 0.9) return double{scenes::none};
  return 1080 - 60 * std::sqrt(1 - r * r) + 0.05 * u + 0.4 * std::sin(u / 8) * std::cos(v / 11);
}

GridMesh build(PointGrid grid, const Lens& lens) {
  SurfaceReport report;
  return build_surface(std::move(grid), lens, {}, report).value();
}

TEST(Simplify, KeepsEveryPointWithinTheErrorWithTenTimesFewerFaces) {
  const Lens lens = half_size_camera();
  const GridMesh mesh = build(scenes::grid(lens, [&](int x, int y) { return forearm(lens, x, y); }), lens);
  const std::vector<Point3f> points = mesh.to_mesh().points;
  std::size_t before = mesh.face_count();
  for (const double error : {0.01, 0.05, 0.5}) {
    const Mesh simple = simplify(mesh, nullptr, {.max_error_mm = error}).value();
    EXPECT_LE(largest_distance(points, simple, lens), error * 1.001);
    EXPECT_LT(simple.faces.size(), before);
    before = simple.faces.size();
    if (error == 0.05) {
      EXPECT_LT(simple.faces.size() * 10, mesh.face_count());
    }
  }
}

TEST(Simplify, HoldsTheErrorOverNoiseHolesAndSteepSlopes) {
  const Lens lens = half_size_camera();
  scenes::Noise noise(1);
  const auto depth = [&](int x, int y) {
    const double step = x > 200 ? 12 / (1 + std::exp((230 - x) / 3.0)) : 0;
    return noise() > 3 ? double{scenes::none} : forearm(lens, x, y) + step + 0.02 * noise();
  };
  const GridMesh mesh = build(scenes::grid(lens, depth), lens);
  const Mesh simple = simplify(mesh, nullptr, {.max_error_mm = 0.08}).value();
  EXPECT_LE(largest_distance(mesh.to_mesh().points, simple, lens), 0.0801);
  EXPECT_LT(simple.faces.size(), mesh.face_count());
}

// Twice the area covered on the image plane: equal areas without overlap mean neither cracks nor doubles.
double covered_pixels(const Mesh& mesh, const Lens& lens) {
  double sum = 0;
  for (const auto& [p, q, r] : mesh.faces) {
    const Eigen::Vector2d a = lens.project(vector(mesh.points[p]));
    const Eigen::Vector2d u = lens.project(vector(mesh.points[q])) - a;
    const Eigen::Vector2d v = lens.project(vector(mesh.points[r])) - a;
    const double area = u.y() * v.x() - u.x() * v.y();  // y is down
    EXPECT_GT(area, 0) << "clockwise";
    sum += area;
  }
  return sum;
}

// Edges without a neighbour in the opposite direction.
auto rim(const Mesh& mesh) {
  std::set<std::array<float, 6>> edges;
  const auto key = [&](std::uint32_t p, std::uint32_t q) {
    const Point3f a = mesh.points[p];
    const Point3f b = mesh.points[q];
    return std::array{a.x, a.y, a.z, b.x, b.y, b.z};
  };
  for (const Face& face : mesh.faces) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (edges.erase(key(face[(i + 1) % 3], face[i])) == 0) edges.insert(key(face[i], face[(i + 1) % 3]));
    }
  }
  return edges;
}

TEST(Simplify, HasNoCracksAndKeepsTheRim) {
  const Lens lens = half_size_camera();
  scenes::Noise noise(1);
  const auto depth = [&](int x, int y) { return noise() > 3 ? double{scenes::none} : forearm(lens, x, y); };
  const GridMesh mesh = build(scenes::grid(lens, depth), lens);
  const Mesh whole = mesh.to_mesh();
  for (const double error : {0.02, 10.0}) {
    const Mesh simple = simplify(mesh, nullptr, {.max_error_mm = error}).value();
    EXPECT_LT(simple.faces.size(), whole.faces.size());
    EXPECT_NEAR(covered_pixels(simple, lens), covered_pixels(whole, lens), 0.5);
    EXPECT_EQ(rim(simple), rim(whole));
    std::vector<bool> used(simple.points.size());
    for (const Face& face : simple.faces) {
      for (const std::uint32_t index : face) used[index] = true;
    }
    EXPECT_EQ(std::ranges::count(used, false), 0);
  }
}

// The colour that a simplified mesh shows at pixels; each is covered by one of its faces.
class Shown {
 public:
  Shown(const Mesh& mesh, const Lens& lens) : colors_(lens.size, {-1, -1, -1}) {
    for (const Face& face : mesh.faces) paint(mesh, lens, face);
  }
  [[nodiscard]] const std::array<double, 3>& at(int x, int y) const { return colors_(x, y); }

 private:
  void paint(const Mesh& mesh, const Lens& lens, const Face& face) {
    std::array<Eigen::Vector2d, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = lens.project(vector(mesh.points[face[i]])).array().round();
    const auto cross = [](const Eigen::Vector2d& u, const Eigen::Vector2d& v) {
      return u.x() * v.y() - u.y() * v.x();
    };
    const double area = cross(p[1] - p[0], p[2] - p[0]);
    const auto [left, right] = std::minmax({p[0].x(), p[1].x(), p[2].x()});
    const auto [top, bottom] = std::minmax({p[0].y(), p[1].y(), p[2].y()});
    for (int y = static_cast<int>(top); y <= static_cast<int>(bottom); ++y) {
      for (int x = static_cast<int>(left); x <= static_cast<int>(right); ++x) {
        const Eigen::Vector2d at(x, y);
        const std::array weights{cross(p[1] - at, p[2] - at) / area, cross(p[2] - at, p[0] - at) / area,
                                 cross(p[0] - at, p[1] - at) / area};
        if (std::ranges::min(weights) < 0) continue;
        colors_(x, y) = {0, 0, 0};
        for (std::size_t i = 0; i < 3; ++i) {
          for (std::size_t k = 0; k < 3; ++k) colors_(x, y)[k] += weights[i] * mesh.colors[face[i]][k];
        }
      }
    }
  }

  Image<std::array<double, 3>> colors_;
};

TEST(Simplify, AMoleOnNoisySkinKeepsItsEdge) {
  const Lens lens = half_size_camera();
  const GridMesh mesh = build(scenes::grid(lens, [&](int x, int y) { return forearm(lens, x, y); }), lens);
  // 3 mm across, 9 pixels; the shot noise of a well exposed frame.
  scenes::Noise noise(1.2);
  ColorImage8 white(lens.size);
  for (int y = 0; y < lens.size.height; ++y) {
    for (int x = 0; x < lens.size.width; ++x) {
      const double r = std::hypot(x - 231.3, y - 155.8) * 0.33;
      const double mole = 1 - 0.35 / (1 + std::exp((r - 1.5) / 0.1));
      for (std::size_t i = 0; i < 3; ++i) {
        white(x, y)[i] = static_cast<std::uint8_t>(std::array{215, 170, 150}[i] * mole + noise() + 0.5);
      }
    }
  }
  const ColorImage8 black;
  const SurfaceColor colors = SurfaceColor::create(white, black).value();
  const Mesh simple = simplify(mesh, &colors, {}).value();
  ASSERT_EQ(simple.colors.size(), simple.points.size());
  EXPECT_LT(simple.faces.size() * 10, mesh.face_count());
  const Shown shown(simple, lens);
  double worst = 0;
  for (int y = 0; y < lens.size.height; ++y) {
    for (int x = 0; x < lens.size.width; ++x) {
      if (!mesh.has(x, y)) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        worst = std::max(worst, std::abs(shown.at(x, y)[i] - white(x, y)[i]));
      }
    }
  }
  EXPECT_LE(worst, SimplifyOptions{}.max_color_error + 0.01);

  // Without the colour bound the mole is lost: the test sees it.
  const Mesh blind = simplify(mesh, &colors, {.max_color_error = 1000}).value();
  EXPECT_LT(blind.faces.size(), simple.faces.size());
  EXPECT_GT(std::abs(Shown(blind, lens).at(231, 156)[0] - white(231, 156)[0]), 40);
}

TEST(Simplify, RefusesBadOptions) {
  const Lens lens = scenes::camera();
  const GridMesh mesh = build(scenes::grid(lens, [](int, int) { return 1000.0; }), lens);
  EXPECT_EQ(simplify(mesh, nullptr, {.max_error_mm = 0}).error().message,
            "simplify: max_error_mm: not positive");
  EXPECT_EQ(simplify(mesh, nullptr, {.max_color_error = -1}).error().message,
            "simplify: max_color_error: not positive");
  const ColorImage8 white({3, 3}, Rgb8{});
  const ColorImage8 black;
  const SurfaceColor colors = SurfaceColor::create(white, black).value();
  EXPECT_EQ(simplify(mesh, &colors, {}).error().message, "simplify: the colours are of another size");
}

TEST(Simplify, AnEmptyMeshStaysEmpty) {
  const Lens lens = scenes::camera();
  const GridMesh mesh = build(scenes::grid(lens, [](int, int) { return scenes::none; }), lens);
  EXPECT_TRUE(simplify(mesh, nullptr, {}).value().points.empty());
}

}  // namespace
}  // namespace bodyscan
