#include "pipeline/geometry/triangulate.hpp"

#include "pipeline/base/instruction_set.hpp"

#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <string>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace bodyscan {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr Size camera_size{151, 112};

// Barrel and pincushion with tangential terms: several percent at the corners.
const Lens camera_lens{camera_size, 190, 187, 74.2, 56.9, {-0.21, 0.07, 0.0015, -0.002, 0.01}};
const Lens projector_lens{{1024, 768}, 1350, 1340, 520, 390, {0.18, -0.12, -0.003, 0.0025, 0.05}};

// Whatever the defaults: almost no point is too uncertain, and the calibration is exact.
constexpr TriangulateOptions trusting{.max_sigma_mm = 5, .max_disagreement = 6, .calibration_px = 0};

// A projector at `position` (mm, camera frame) that looks at the point 1 m ahead, turned about its own axis.
Calibration rig(const Eigen::Vector3d& position, double turn_degrees = 0) {
  const Eigen::Vector3d forward = (Eigen::Vector3d(0, 0, 1000) - position).normalized();
  const Eigen::Vector3d right = Eigen::Vector3d::UnitY().cross(forward).normalized();
  Eigen::Matrix3d looking;
  looking << right.transpose(), forward.cross(right).transpose(), forward.transpose();
  const Eigen::AngleAxisd turn(turn_degrees * std::numbers::pi / 180, Eigen::Vector3d::UnitZ());
  Calibration calibration{camera_lens, projector_lens, {}};
  calibration.projector_from_camera.rotation = turn.toRotationMatrix() * looking;
  calibration.projector_from_camera.translation = -(calibration.projector_from_camera.rotation * position);
  return calibration;
}

const Eigen::Vector3d above{0, -270, 10};
const Eigen::Vector3d beside{-270, 0, 10};
const Eigen::Vector3d diagonal{-190, -190, 10};

// Depth along the ray (x, y, 1) at which it meets the surface, if it does.
using Surface = std::optional<double> (*)(const Eigen::Vector3d& ray);

std::optional<double> tilted_plane(const Eigen::Vector3d& ray) {
  const Eigen::Vector3d normal(0.25, -0.3, 1);
  return 1000 / normal.dot(ray);
}

std::optional<double> ball(const Eigen::Vector3d& ray) {
  const Eigen::Vector3d centre(30, -20, 1000);
  const double radius = 180;
  const double a = ray.squaredNorm();
  const double b = ray.dot(centre);
  const double under = b * b - a * (centre.squaredNorm() - radius * radius);
  if (under < 0) return std::nullopt;
  return (b - std::sqrt(under)) / a;
}

struct View {
  explicit View(const Calibration& rig_, Surface surface) : rig(rig_), depth(camera_size, nan) {
    for (int y = 0; y < camera_size.height; ++y) {
      for (int x = 0; x < camera_size.width; ++x)
        if (const auto z = surface(ray(x, y))) depth(x, y) = static_cast<float>(*z);
    }
  }

  [[nodiscard]] Eigen::Vector3d ray(int x, int y) const { return rig.camera.ray({x, y}); }
  // Row and column of the projector that light the point; their true values, not rounded.
  [[nodiscard]] Eigen::Vector2d lit_by(const Eigen::Vector3d& point) const {
    return rig.projector.project(rig.projector_from_camera * point);
  }

  Calibration rig;
  FloatImage depth;
};

struct Measuring {
  double row_sigma = 0.02;
  double column_sigma = 0.02;
  bool noisy = false;
  bool rows = true;
  bool columns = true;
};

Correspondence measure(const View& view, Surface surface, const Measuring& measuring) {
  Correspondence found;
  found.camera = camera_size;
  found.projector = view.rig.projector.size;
  const auto axis = [&](double sigma, int coordinate, unsigned seed) {
    AxisCorrespondence result{FloatImage(camera_size, nan),
                              FloatImage(camera_size, static_cast<float>(sigma))};
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, measuring.noisy ? sigma : 0);
    for (int y = 0; y < camera_size.height; ++y) {
      for (int x = 0; x < camera_size.width; ++x) {
        const Eigen::Vector3d ray = view.ray(x, y);
        if (const auto z = surface(ray))
          result.coordinate(x, y) =
              static_cast<float>(view.lit_by(*z * ray)[coordinate] + (measuring.noisy ? normal(random) : 0));
      }
    }
    return result;
  };
  if (measuring.rows) found.rows = axis(measuring.row_sigma, 1, 1);
  if (measuring.columns) found.columns = axis(measuring.column_sigma, 0, 2);
  return found;
}

PointGrid points_of(const Correspondence& found, const Calibration& rig,
                    const TriangulateOptions& options = trusting) {
  auto grid = triangulate(found, rig, options);
  EXPECT_TRUE(grid.has_value()) << grid.error().message;
  return *std::move(grid);
}

struct Errors {
  int points = 0;
  int missing = 0;  // of those that the surface has
  double worst_mm = 0;
  double depth_rms_mm = 0;
  double normalised_rms = 0;  // depth error over predicted sigma
};

Errors errors_of(const PointGrid& grid, const View& view) {
  Errors errors;
  for (int y = 0; y < camera_size.height; ++y) {
    for (int x = 0; x < camera_size.width; ++x) {
      const double depth = view.depth(x, y);
      if (std::isnan(depth)) {
        EXPECT_FALSE(grid.has(x, y)) << x << ' ' << y;
        continue;
      }
      if (!grid.has(x, y)) {
        ++errors.missing;
        continue;
      }
      ++errors.points;
      const Point3f& point = grid.points(x, y);
      const Eigen::Vector3d difference = Eigen::Vector3d(point.x, point.y, point.z) - depth * view.ray(x, y);
      errors.worst_mm = std::max(errors.worst_mm, difference.norm());
      errors.depth_rms_mm += difference.z() * difference.z();
      errors.normalised_rms += std::pow(difference.z() / static_cast<double>(grid.sigma_mm(x, y)), 2);
    }
  }
  errors.depth_rms_mm = std::sqrt(errors.depth_rms_mm / errors.points);
  errors.normalised_rms = std::sqrt(errors.normalised_rms / errors.points);
  return errors;
}

struct Set {
  const char* name;
  Eigen::Vector3d position;
  double turn_degrees;
  bool rows;
  bool columns;
};

void PrintTo(const Set& set, std::ostream* out) {
  *out << set.name;
}

class ExactCoordinates : public testing::TestWithParam<Set> {};

TEST_P(ExactCoordinates, GiveTheSurfaceThroughBothLenses) {
  const Set& set = GetParam();
  for (const Surface surface : {tilted_plane, ball}) {
    const View view(rig(set.position, set.turn_degrees), surface);
    const Correspondence found = measure(view, surface, {.rows = set.rows, .columns = set.columns});
    const Errors errors = errors_of(points_of(found, view.rig), view);
    EXPECT_EQ(errors.missing, 0);
    EXPECT_GT(errors.points, 2000);
    EXPECT_LT(errors.worst_mm, 1e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(Triangulate, ExactCoordinates,
                         testing::Values(Set{"rows", above, 0, true, false},
                                         Set{"columns", beside, 0, false, true},
                                         Set{"both", diagonal, 0, true, true},
                                         Set{"turned_90_rows", beside, 90, true, false},
                                         Set{"turned_90_columns", above, -90, false, true},
                                         Set{"turned_180_rows", above, 180, true, false},
                                         Set{"turned_30_both", above, 30, true, true}),
                         [](const auto& tested) { return tested.param.name; });

TEST(Triangulate, BothAxesAreBetterThanEither) {
  const View view(rig(diagonal), tilted_plane);
  const auto rms = [&](bool rows, bool columns) {
    const Measuring measuring{
        .row_sigma = 0.03, .column_sigma = 0.03, .noisy = true, .rows = rows, .columns = columns};
    return errors_of(points_of(measure(view, tilted_plane, measuring), view.rig), view).depth_rms_mm;
  };
  EXPECT_LT(rms(true, true), 0.8 * std::min(rms(true, false), rms(false, true)));
}

TEST(Triangulate, ANoisyAxisDoesNotHurt) {
  const View view(rig(diagonal), tilted_plane);
  const auto rms = [&](bool columns) {
    const Measuring measuring{.row_sigma = 0.02, .column_sigma = 0.5, .noisy = true, .columns = columns};
    return errors_of(points_of(measure(view, tilted_plane, measuring), view.rig), view).depth_rms_mm;
  };
  EXPECT_LT(rms(true), 1.001 * rms(false));
}

TEST(Triangulate, OneAxisIsEnoughWhereTheOtherIsUndecided) {
  const View view(rig(diagonal), tilted_plane);
  Correspondence found = measure(view, tilted_plane, {});
  for (int y = 0; y < camera_size.height; ++y) {
    for (int x = 0; x < camera_size.width; ++x) {
      if (x < 50) found.rows->coordinate(x, y) = nan;
      if (x >= 40 && x < 80) found.columns->coordinate(x, y) = nan;
    }
  }
  const PointGrid grid = points_of(found, view.rig);
  for (int x = 0; x < camera_size.width; ++x) EXPECT_EQ(grid.has(x, 60), x < 40 || x >= 50) << x;
  EXPECT_NEAR(grid.points(20, 60).z, view.depth(20, 60), 1e-3);
  EXPECT_NEAR(grid.points(60, 60).z, view.depth(60, 60), 1e-3);
}

TEST(Triangulate, PixelsWhoseAxesDisagreeAreLeftOut) {
  const View view(rig(diagonal), tilted_plane);
  Correspondence found = measure(view, tilted_plane, {});
  for (int y = 0; y < camera_size.height; ++y)
    for (int x = 0; x < 50; ++x) found.columns->coordinate(x, y) += 1;
  const PointGrid strict = points_of(found, view.rig);
  TriangulateOptions options = trusting;
  options.max_disagreement = 100;
  const PointGrid lax = points_of(found, view.rig, options);
  options = trusting;
  options.calibration_px = 0.4F;
  const PointGrid calibrated = points_of(found, view.rig, options);
  for (int y = 0; y < camera_size.height; ++y) {
    for (int x = 0; x < camera_size.width; ++x) {
      ASSERT_EQ(strict.has(x, y), x >= 50) << x << ' ' << y;
      ASSERT_TRUE(lax.has(x, y));
      ASSERT_TRUE(calibrated.has(x, y));
    }
  }
}

TEST(Triangulate, SigmaIsTheDepthsDerivative) {
  const View view(rig(above), tilted_plane);
  const Correspondence exact = measure(view, tilted_plane, {.row_sigma = 0.1, .columns = false});
  const auto shifted = [&](float shift) {
    Correspondence found = measure(view, tilted_plane, {.row_sigma = 0.1, .columns = false});
    for (float& row : found.rows->coordinate.pixels()) row += shift;
    return points_of(found, view.rig);
  };
  const PointGrid nearer = shifted(-0.5F);
  const PointGrid farther = shifted(0.5F);
  const PointGrid grid = points_of(exact, view.rig);
  for (int y = 0; y < camera_size.height; y += 7) {
    for (int x = 0; x < camera_size.width; x += 7) {
      const double slope = std::abs(farther.points(x, y).z - nearer.points(x, y).z);  // mm a row
      EXPECT_NEAR(grid.sigma_mm(x, y), 0.1 * slope, 0.002 * slope) << x << ' ' << y;
    }
  }
}

TEST(Triangulate, SigmaOfBothAxesIsTheActualSpread) {
  const View view(rig(diagonal), ball);
  const Correspondence found = measure(view, ball, {.row_sigma = 0.03, .column_sigma = 0.05, .noisy = true});
  EXPECT_NEAR(errors_of(points_of(found, view.rig), view).normalised_rms, 1, 0.05);
}

TEST(Triangulate, PointsLessCertainThanAskedForAreLeftOut) {
  const View view(rig(above), tilted_plane);
  Correspondence found = measure(view, tilted_plane, {.columns = false});
  for (int y = 0; y < camera_size.height; ++y)
    for (int x = 0; x < 50; ++x) found.rows->sigma(x, y) = 10;
  const PointGrid grid = points_of(found, view.rig);
  EXPECT_FALSE(grid.has(20, 60));
  EXPECT_TRUE(grid.has(70, 60));
  TriangulateOptions options = trusting;
  options.max_sigma_mm = 0.001F;
  EXPECT_FALSE(points_of(found, view.rig, options).has(70, 60));
}

TEST(Triangulate, BehindTheCameraAndAtInfinityThereIsNoPoint) {
  Calibration calibration = rig(above);
  calibration.projector.distortion = {};
  const View view(calibration, tilted_plane);
  Correspondence found = measure(view, tilted_plane, {.columns = false});
  const Eigen::Vector3d ray = view.ray(70, 50);
  // The row that a point infinitely far along the ray would have, and rows beyond it.
  const double infinite = calibration.projector.project(calibration.projector_from_camera.rotation * ray).y();
  const double at_a_metre = found.rows->coordinate(70, 50);
  const double beyond = infinite > at_a_metre ? 40 : -40;
  found.rows->coordinate(70, 50) = static_cast<float>(infinite);
  found.rows->coordinate(71, 50) = static_cast<float>(infinite + beyond);
  found.rows->coordinate(72, 50) = static_cast<float>(infinite + 5 * beyond);
  found.rows->coordinate(73, 50) = nan;
  // Behind the camera, yet before the projector.
  const Eigen::Vector2d near_row = view.lit_by(-20 * view.ray(74, 50));
  ASSERT_GT((calibration.projector_from_camera * (-20 * view.ray(74, 50))).z(), 0);
  found.rows->coordinate(74, 50) = static_cast<float>(near_row.y());
  const PointGrid grid = points_of(found, calibration);
  EXPECT_TRUE(grid.has(69, 50));
  for (const int x : {70, 71, 72, 73, 74}) EXPECT_FALSE(grid.has(x, 50)) << x << ' ' << grid.points(x, 50).z;
  EXPECT_TRUE(grid.has(75, 50));
}

TEST(Triangulate, NoPointIsBehindTheProjector) {
  // A projector far ahead of the camera that looks back at it: rows alone fit points on both of its sides.
  Calibration calibration = rig({0, -200, 1500});
  const View view(calibration, tilted_plane);
  Correspondence found = measure(view, tilted_plane, {.columns = false});
  const Eigen::Vector3d behind = 2500 * view.ray(70, 20);
  const Eigen::Vector3d seen = calibration.projector_from_camera * behind;
  ASSERT_LT(seen.z(), 0);
  found.rows->coordinate(70, 20) =
      static_cast<float>(calibration.projector.fy * seen.y() / seen.z() + calibration.projector.cy);
  EXPECT_FALSE(points_of(found, calibration).has(70, 20));
}

TEST(Triangulate, SizesThatAreNotTheCalibrationsNameBoth) {
  const View view(rig(above), tilted_plane);
  Correspondence found = measure(view, tilted_plane, {.columns = false});
  Calibration other = view.rig;
  other.camera.size = {4288, 2848};
  const auto camera = triangulate(found, other);
  ASSERT_FALSE(camera.has_value());
  EXPECT_EQ(camera.error().kind, ErrorKind::input);
  EXPECT_NE(camera.error().message.find("4288 x 2848"), std::string::npos) << camera.error().message;
  EXPECT_NE(camera.error().message.find("151 x 112"), std::string::npos) << camera.error().message;
  other = view.rig;
  other.projector.size = {800, 600};
  const auto projector = triangulate(found, other);
  ASSERT_FALSE(projector.has_value());
  EXPECT_NE(projector.error().message.find("800 x 600"), std::string::npos) << projector.error().message;
  EXPECT_NE(projector.error().message.find("1024 x 768"), std::string::npos) << projector.error().message;
}

TEST(Triangulate, OptionsOutOfRangeAreUsageErrors) {
  const View view(rig(above), tilted_plane);
  const Correspondence found = measure(view, tilted_plane, {.columns = false});
  for (const TriangulateOptions options :
       {TriangulateOptions{0, 6, 0}, TriangulateOptions{nan, 6, 0}, TriangulateOptions{5, -1, 0},
        TriangulateOptions{5, nan, 0}, TriangulateOptions{5, 6, -1}, TriangulateOptions{5, 6, nan}}) {
    const auto grid = triangulate(found, view.rig, options);
    ASSERT_FALSE(grid.has_value());
    EXPECT_EQ(grid.error().kind, ErrorKind::usage);
  }
}

class TriangulateInstructionSets : public testing::TestWithParam<InstructionSet> {
 protected:
  void TearDown() override { force_instruction_set(before_); }

 private:
  InstructionSet before_ = active_instruction_set();
};

TEST_P(TriangulateInstructionSets, GiveTheSamePoints) {
  const View view(rig(diagonal), ball);
  const Correspondence found = measure(view, ball, {.noisy = true});
  ASSERT_TRUE(force_instruction_set(InstructionSet::v2));
  const PointGrid plain = points_of(found, view.rig);
  if (!force_instruction_set(GetParam())) {
    const std::string message = "SKIPPED: this processor lacks x86-64-v" +
                                std::to_string(static_cast<int>(GetParam()) + 2) +
                                ", its kernels stay untested";
    std::cerr << message << '\n';
    GTEST_SKIP() << message;
  }
  const PointGrid fast = points_of(found, view.rig);
  for (int y = 0; y < camera_size.height; ++y) {
    for (int x = 0; x < camera_size.width; ++x) {
      ASSERT_EQ(fast.has(x, y), plain.has(x, y)) << x << ' ' << y;
      if (!plain.has(x, y)) continue;
      ASSERT_NEAR(fast.points(x, y).z, plain.points(x, y).z, 1e-3);
      ASSERT_NEAR(fast.sigma_mm(x, y), plain.sigma_mm(x, y), 1e-3 * plain.sigma_mm(x, y));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Triangulate, TriangulateInstructionSets,
                         testing::Values(InstructionSet::v3, InstructionSet::v4),
                         [](const auto& tested) { return tested.param == InstructionSet::v3 ? "v3" : "v4"; });

}  // namespace
}  // namespace bodyscan
