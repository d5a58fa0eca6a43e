#include "tools/evaluate/shapes.hpp"

#include "tests/tools/evaluate/scenes.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace bodyscan {
namespace {

using Eigen::Vector3d;

TEST(Steps, ReportEachFaceAndTheDifferenceToTheOneBefore) {
  const Plane low{-Vector3d::UnitZ(), -1000};
  const Plane high{-Vector3d::UnitZ(), -997};
  Truth truth = make_truth([&](const Vector3d& ray) { return hit_plane(ray.x() < 0 ? low : high, ray); },
                           square_mesh(1000));
  truth.facts.steps = {{"step 100", low}, {"step 103", high}};
  const std::vector<Point3f> points =
      displaced(truth, [](const Vector3d& at) { return at.x() < 0 ? 0.01 : -0.02; });
  const std::vector<StepResult> steps = measure_steps(truth, points, measure_deviations(truth, points));
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_NEAR(steps[0].height_error_mm, 0.01, 1e-4);
  EXPECT_NEAR(steps[1].height_error_mm, -0.02, 1e-4);
  EXPECT_NEAR(steps[1].step_error_mm, -0.03, 1e-4);
  EXPECT_NEAR(steps[1].noise_mm, 0, 1e-4);
  EXPECT_EQ(steps[0].points + steps[1].points, points.size());
}

TEST(Spheres, SizeSpacingAndForm) {
  const Sphere left{Vector3d(-60, 0, 1000), 30};
  const Sphere right{Vector3d(60, 0, 1000), 30};
  Truth truth = make_truth([&](const Vector3d& ray) { return hit_sphere(ray.x() < 0 ? left : right, ray); },
                           square_mesh(1000));
  truth.facts.spheres = {left, right};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-0.05, 0.05);
  std::vector<Point3f> points = displaced(truth, [&](const Vector3d&) { return 0.02 + noise(random); });
  for (Point3f& point : points) {
    if (point.x > 0) point.x += 0.03F;
  }
  const std::vector<SphereResult> spheres = measure_spheres(truth, points, measure_deviations(truth, points));
  ASSERT_EQ(spheres.size(), 2U);
  EXPECT_NEAR(spheres[0].diameter_error_mm, 0.04, 0.01);
  EXPECT_NEAR(spheres[1].diameter_error_mm, 0.04, 0.01);
  EXPECT_NEAR(sphere_spacing_error(truth, spheres), 0.03, 0.005);
  EXPECT_NEAR(spheres[0].form_mm, 0.0997, 0.004);
}

TEST(Planes, FlatnessIsTheRangeOfTheResiduals) {
  const Truth truth = make_wall(1000);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> noise(-0.1, 0.1);
  const std::vector<Point3f> points =
      displaced(truth, [&](const Vector3d& at) { return 0.002 * at.x() + noise(random); });
  const std::vector<PlaneResult> planes = measure_planes(truth, points, measure_deviations(truth, points));
  ASSERT_EQ(planes.size(), 1U);
  EXPECT_EQ(planes[0].points, points.size());
  EXPECT_NEAR(planes[0].flatness_mm, 0.2 * 0.997, 0.004);
  EXPECT_NEAR(planes[0].noise_mm, 0.2 / std::sqrt(12.0), 0.002);
}

// The truth of a wall with one bump; relief is small beside the distance, so the ray's depth is the plane's.
Truth make_bump_wall(const Bump& bump) {
  const auto relief = [bump](const Vector3d& at) {
    const double r =
        std::min(0.5, std::hypot(at.x() - bump.center.x(), at.y() - bump.center.y()) / bump.diameter);
    return bump.height / 2 * (1 + std::cos(2 * std::numbers::pi * r));
  };
  Truth truth = make_truth(
      [&](const Vector3d& ray) -> std::optional<Hit> {
        const Vector3d at = ray * 1000;
        return Hit{ray * (1000 - relief(at)), -Vector3d::UnitZ()};
      },
      square_mesh(1000));
  truth.facts.planes.push_back({"plate", {-Vector3d::UnitZ(), -1000}});
  truth.facts.bumps.push_back(bump);
  return truth;
}

TEST(Bumps, KeptIsTheSlopeOfMeasuredOnTrueRelief) {
  const Bump bump{Vector3d(12, -7, 1000), 20, 0.5};
  const Truth truth = make_bump_wall(bump);
  const auto lowered = [](const Vector3d& at) { return -0.2 * (1000 - at.z()) + 0.07; };
  const std::vector<Point3f> points = displaced(truth, lowered);
  const std::vector<BumpResult> bumps = measure_bumps(truth, points, measure_deviations(truth, points));
  ASSERT_EQ(bumps.size(), 1U);
  EXPECT_EQ(bumps[0].bumps, 1U);
  EXPECT_NEAR(bumps[0].kept, 0.8, 0.002);
}

TEST(Bumps, AFlatModelKeepsNothing) {
  const Bump bump{Vector3d(12, -7, 1000), 20, 0.5};
  const Truth truth = make_bump_wall(bump);
  const std::vector<Point3f> points = displaced(truth, [](const Vector3d& at) { return at.z() - 1000; });
  const std::vector<BumpResult> bumps = measure_bumps(truth, points, measure_deviations(truth, points));
  ASSERT_EQ(bumps.size(), 1U);
  EXPECT_NEAR(bumps[0].kept, 0, 0.01);
}

}  // namespace
}  // namespace bodyscan
