#include "tools/simulator/renderer.hpp"

#include "pipeline/base/parallel.hpp"
#include "tools/simulator/sensor.hpp"
#include "tools/simulator/shapes.hpp"
#include "tools/simulator/skin.hpp"
#include "tools/simulator/subjects.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace bodyscan::simulator {
namespace {

using Eigen::Vector3d;

constexpr Pattern white{.kind = PatternKind::white};
constexpr Pattern black{.kind = PatternKind::black};

RenderOptions quiet_options() {
  RenderOptions options;
  options.rig.scale = 1.0 / 16;
  options.full_well = 0;
  return options;
}

// A plate that faces the camera at 1.05 m, larger than the picture, and a small one that shades it.
Scene shaded_plate() {
  Scene scene;
  scene.calibration = make_rig(quiet_options().rig).value();
  append_rectangle(scene.subject.mesh, Vector3d(0, 0, 1050), Vector3d(500, 0, 0), Vector3d(0, 400, 0));
  append_rectangle(scene.subject.mesh, Vector3d(0, 60, 900), Vector3d(60, 0, 0), Vector3d(0, 40, 0));
  return scene;
}

double green(const ColorImage8& image, int x, int y) {
  return srgb_to_linear(image(x, y)[1] / 255.0);
}

// The pixel that sees a point.
std::array<int, 2> pixel_of(const Scene& scene, const Vector3d& point) {
  const Eigen::Vector2d pixel = scene.calibration.camera.project(point);
  return {static_cast<int>(std::lround(pixel.x())), static_cast<int>(std::lround(pixel.y()))};
}

TEST(Renderer, WhiteMattReachesItsShareOfFullScaleByCosineAndDistance) {
  const Scene scene = shaded_plate();
  RenderOptions options = quiet_options();
  options.ambient = 0;
  options.reflection = 0;
  const ColorImage8 image = Renderer::make(scene, options).value().frame(white, 0);
  const Vector3d projector(0, 268, 0);
  for (const Vector3d& point :
       {Vector3d(150, 0, 1050), Vector3d(-180, 120, 1050), Vector3d(170, -150, 1050)}) {
    const auto [x, y] = pixel_of(scene, point);
    const double distance2 = (projector - point).squaredNorm();
    const double reference2 = projector.squaredNorm() + 1050 * 1050;
    const double wanted = 0.75 * 1050 / std::sqrt(distance2) * reference2 / distance2;
    EXPECT_NEAR(green(image, x, y), wanted, 0.006) << point.transpose();
  }
}

TEST(Renderer, BlackIsWhiteOverTheContrast) {
  const Scene scene = shaded_plate();
  RenderOptions options = quiet_options();
  options.ambient = 0;
  options.reflection = 0;
  options.contrast = 8;
  const Renderer renderer = Renderer::make(scene, options).value();
  const auto [x, y] = pixel_of(scene, Vector3d(150, 0, 1050));
  EXPECT_NEAR(green(renderer.frame(white, 0), x, y) / green(renderer.frame(black, 1), x, y), 8, 0.3);
}

TEST(Renderer, ShadowsGetAmbientAndInterReflectedLightOnly) {
  const Scene scene = shaded_plate();
  RenderOptions options = quiet_options();
  options.reflection = 0.2;
  options.ambient = 0.1;
  const Renderer renderer = Renderer::make(scene, options).value();
  // Seen by the camera over the small plate's upper edge, hidden from the projector below.
  const auto [x, y] = pixel_of(scene, Vector3d(0, 10, 1050));
  const TruthMaps truth = renderer.truth();
  ASSERT_NEAR(truth.depth(x, y), 1050, 1e-3);
  ASSERT_TRUE(std::isnan(truth.rows(x, y)));
  const Pattern half{PatternKind::gray, Axis::row, 0, false};
  EXPECT_NEAR(green(renderer.frame(white, 0), x, y), 0.1 + 0.2 * 0.75, 0.004);
  EXPECT_NEAR(green(renderer.frame(half, 0), x, y), 0.1 + 0.2 * 0.75 * (0.5 + 0.5 / 400), 0.004);
  EXPECT_NEAR(green(renderer.frame(black, 0), x, y), 0.1 + 0.2 * 0.75 / 400, 0.004);
}

TEST(Renderer, DimsWithTheLight) {
  const Scene scene = shaded_plate();
  RenderOptions options = quiet_options();
  options.ambient = 0;
  options.light = 0.25;
  const auto [x, y] = pixel_of(scene, Vector3d(150, 0, 1050));
  const double dim = green(Renderer::make(scene, options).value().frame(white, 0), x, y);
  options.light = 1;
  const double bright = green(Renderer::make(scene, options).value().frame(white, 0), x, y);
  EXPECT_NEAR(bright / dim, 4, 0.1);
}

TEST(Renderer, AGrayPatternIsBrightWhereTheTruthsRowIsWhite) {
  const Scene scene = shaded_plate();
  const Renderer renderer = Renderer::make(scene, quiet_options()).value();
  const TruthMaps truth = renderer.truth();
  const Pattern rows{PatternKind::gray, Axis::row, 6, false};
  const Pattern columns{PatternKind::gray, Axis::column, 6, true};
  const ColorImage8 row_image = renderer.frame(rows, 0);
  const ColorImage8 column_image = renderer.frame(columns, 0);
  int judged = 0;
  for (int y = 0; y < truth.rows.height(); ++y) {
    for (int x = 0; x < truth.rows.width(); ++x) {
      if (truth.reachable(x, y) == 0) continue;
      const auto clear = [](float coordinate) {  // far from the edges of stripes of 64 px
        const double phase = (static_cast<double>(coordinate) + 0.5) / 64;
        return std::abs(phase - std::round(phase)) > 0.1;
      };
      if (!clear(truth.rows(x, y)) || !clear(truth.columns(x, y))) continue;
      ++judged;
      const auto row = static_cast<unsigned>(std::lround(truth.rows(x, y)));
      const auto column = static_cast<unsigned>(std::lround(truth.columns(x, y)));
      ASSERT_EQ(green(row_image, x, y) > 0.3, pattern_is_white(rows, row)) << x << ' ' << y;
      ASSERT_EQ(green(column_image, x, y) > 0.3, pattern_is_white(columns, column)) << x << ' ' << y;
    }
  }
  EXPECT_GT(judged, 5000);
}

// The shaded plate through the half-size camera's middle 96 x 96 pixels.
Scene close_up() {
  Scene scene = shaded_plate();
  scene.calibration =
      make_rig({.name = "rows", .scale = 0.5, .projector = {1024, 768}, .projector_roll = 0}).value();
  Lens& camera = scene.calibration.camera;
  camera.size = {96, 96};
  camera.cx -= 1300;
  camera.cy -= 660;
  return scene;
}

TEST(Renderer, StripeEdgesLieHalfWayBetweenRows) {
  const Scene scene = close_up();
  RenderOptions options = quiet_options();
  options.full_well = 22000;  // the noise dithers the 8-bit steps
  const Renderer renderer = Renderer::make(scene, options).value();
  const TruthMaps truth = renderer.truth();
  const ColorImage8 pattern = renderer.frame({PatternKind::gray, Axis::row, 2, false}, 0);
  const ColorImage8 inverse = renderer.frame({PatternKind::gray, Axis::row, 2, true}, 1);
  int edges = 0;
  double sum = 0;
  double squares = 0;
  for (int x = 0; x < 96; ++x) {
    for (int y = 0; y + 1 < 96; ++y) {
      const double here = green(pattern, x, y) - green(inverse, x, y);
      const double below = green(pattern, x, y + 1) - green(inverse, x, y + 1);
      if ((here < 0) == (below < 0)) continue;
      const double t = here / (here - below);
      const double row =
          std::lerp(static_cast<double>(truth.rows(x, y)), static_cast<double>(truth.rows(x, y + 1)), t);
      const double error = row - (std::floor(row) + 0.5);
      ++edges;
      sum += error;
      squares += error * error;
    }
  }
  ASSERT_GT(edges, 300);
  EXPECT_NEAR(sum / edges, 0, 0.004);
  EXPECT_LT(std::sqrt(squares / edges), 0.03);
}

TEST(Renderer, SubsurfaceScatteringTakesContrastFromRedFirst) {
  Scene scene = close_up();
  scene.subject.material = Material::skin;
  RenderOptions options = quiet_options();
  options.reflection = 0;
  const auto contrast = [&](double share) {
    options.subsurface = share;
    const Renderer renderer = Renderer::make(scene, options).value();
    const ColorImage8 stripes = renderer.frame({PatternKind::gray, Axis::row, 1, false}, 0);
    const ColorImage8 full = renderer.frame(white, 0);
    std::array<double, 3> swing{};
    for (unsigned c = 0; c < 3; ++c) {
      double low = 1;
      double high = 0;
      for (int y = 0; y < 96; ++y) {
        const double value =
            srgb_to_linear(stripes(40, y)[c] / 255.0) / srgb_to_linear(full(40, y)[c] / 255.0);
        low = std::min(low, value);
        high = std::max(high, value);
      }
      swing[c] = high - low;
    }
    return swing;
  };
  const auto none = contrast(0);
  const auto some = contrast(0.5);
  EXPECT_GT(none[0], 0.9);
  EXPECT_LT(some[0], some[1] - 0.03);
  EXPECT_LT(some[1], some[2] - 0.03);
  EXPECT_LT(some[2], none[2] - 0.1);
  EXPECT_EQ(contrast(-1), some);  // skin's own share
}

TEST(Renderer, ReachablePixelsAreLitSmoothAndInside) {
  const Scene scene = shaded_plate();
  const TruthMaps truth = Renderer::make(scene, quiet_options()).value().truth();
  std::size_t reachable = 0;
  for (int y = 0; y < truth.depth.height(); ++y) {
    for (int x = 0; x < truth.depth.width(); ++x) {
      if (truth.reachable(x, y) == 0) continue;
      ++reachable;
      ASSERT_FALSE(std::isnan(truth.rows(x, y)));
      for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        ASSERT_FALSE(std::isnan(truth.rows(x + dx, y + dy)));
        ASSERT_LT(std::abs(truth.depth(x + dx, y + dy) - truth.depth(x, y)), 1.0F);
      }
    }
  }
  EXPECT_GT(reachable, truth.depth.size().area() / 2);
  // The edges of the small plate, seen by the camera, are mixed pixels.
  for (const double edge : {-60.0, 60.0}) {
    const auto [x, y] = pixel_of(scene, Vector3d(edge, 60, 900));
    EXPECT_EQ(truth.reachable(x, y), 0);
  }
  const auto [x, y] = pixel_of(scene, Vector3d(0, 60, 900));
  EXPECT_EQ(truth.reachable(x, y), 255);
}

TEST(Renderer, ASharplyCurvedReliefIsReachableAStepOfItsHeightIsNot) {
  RenderOptions options = quiet_options();
  options.rig.scale = 0.25;
  Scene relief;
  relief.calibration = make_rig(options.rig).value();
  relief.subject = make_bumps();
  for (Vector3d& point : relief.subject.mesh.points) point.z() += 1050;
  const TruthMaps bumps = Renderer::make(relief, options).value().truth();
  int missing = 0;
  for (const BumpFact& bump : relief.subject.facts.bumps) {
    const auto [x, y] = pixel_of(relief, bump.center + Vector3d(0, 0, 1050));
    missing += bumps.reachable(x, y) == 0;
  }
  EXPECT_EQ(missing, 0);

  Scene step;
  step.calibration = relief.calibration;
  append_rectangle(step.subject.mesh, Vector3d(-50, 0, 1050), Vector3d(50, 0, 0), Vector3d(0, 50, 0));
  append_rectangle(step.subject.mesh, Vector3d(50, 0, 1050.5), Vector3d(50, 0, 0), Vector3d(0, 50, 0));
  const TruthMaps stepped = Renderer::make(step, options).value().truth();
  const auto [x, y] = pixel_of(step, Vector3d(0, 0, 1050));
  EXPECT_EQ(stepped.reachable(x, y), 0);
  EXPECT_EQ(stepped.reachable(x - 3, y), 255);
  EXPECT_EQ(stepped.reachable(x + 3, y), 255);
}

TEST(Renderer, GrazingSurfacesAreNotReachable) {
  Scene scene;
  RenderOptions options = quiet_options();
  options.rig.scale = 0.25;
  scene.calibration = make_rig(options.rig).value();
  const SphereFact sphere{Vector3d(0, 0, 1050), 60};
  append_sphere(scene.subject.mesh, sphere, 0.5);
  const TruthMaps truth = Renderer::make(scene, options).value().truth();
  const double limit = std::cos(75 * std::numbers::pi / 180);
  double smallest = 1;
  for (int y = 0; y < truth.depth.height(); ++y) {
    for (int x = 0; x < truth.depth.width(); ++x) {
      if (truth.reachable(x, y) == 0) continue;
      const Vector3d point =
          scene.calibration.camera.ray(Eigen::Vector2d(x, y)) * static_cast<double>(truth.depth(x, y));
      const Vector3d normal = (point - sphere.center).normalized();
      const double to_camera = -normal.dot(point.normalized());
      const double to_projector = normal.dot((Vector3d(0, 268, 0) - point).normalized());
      smallest = std::min({smallest, to_camera, to_projector});
      EXPECT_LT((truth.normal(x, y).cast<double>() - normal).norm(), 0.01);
    }
  }
  EXPECT_GT(smallest, limit - 0.005);
  EXPECT_LT(smallest, limit + 0.06);
}

TEST(Renderer, PicturesDependOnTheSeedNotOnTheThreads) {
  const Scene scene = shaded_plate();
  RenderOptions options = quiet_options();
  options.full_well = 22000;
  const Renderer renderer = Renderer::make(scene, options).value();
  const ColorImage8 image = renderer.frame(white, 3);
  ColorImage8 serial;
  parallel_for(0, 2, 1, [&](int begin, int) {  // inside the pool, work stays on one thread
    if (begin == 0) serial = renderer.frame(white, 3);
  });
  const auto same = [&](const ColorImage8& other) {
    return std::equal(image.pixels().begin(), image.pixels().end(), other.pixels().begin());
  };
  EXPECT_TRUE(same(serial));
  EXPECT_FALSE(same(renderer.frame(white, 4)));
  options.seed = 2;
  EXPECT_FALSE(same(Renderer::make(scene, options).value().frame(white, 3)));
}

FloatImage linear_picture(const GrayImage8& picture) {
  FloatImage light(picture.size());
  for (std::size_t i = 0; i < light.pixels().size(); ++i)
    light.pixels()[i] = static_cast<float>(srgb_to_linear(picture.pixels()[i] / 255.0));
  return light;
}

TEST(Renderer, APictureThatEqualsAPatternGivesTheSamePixels) {
  const Scene scene = shaded_plate();
  RenderOptions options = quiet_options();
  options.full_well = 22000;
  options.subsurface = 0.3;
  const Renderer renderer = Renderer::make(scene, options).value();
  int index = 0;
  for (const Pattern& pattern : {white, black, Pattern{PatternKind::gray, Axis::row, 3, true},
                                 Pattern{PatternKind::gray, Axis::column, 5, false}}) {
    const GrayImage8 picture = render_pattern(pattern, scene.calibration.projector.size);
    const ColorImage8 wanted = renderer.frame(pattern, index);
    const ColorImage8 rendered = renderer.frame(linear_picture(picture), index);
    EXPECT_TRUE(std::ranges::equal(wanted.pixels(), rendered.pixels())) << describe(pattern);
    ++index;
  }
}

TEST(Renderer, APictureThatChangesAlongBothAxesLightsWhatItShows) {
  const Scene scene = shaded_plate();
  const Renderer renderer = Renderer::make(scene, quiet_options()).value();
  const TruthMaps truth = renderer.truth();
  FloatImage shown(scene.calibration.projector.size, 0);
  for (int y = 0; y < 300; ++y) std::fill_n(shown.row(y), 600, 1.0F);
  const ColorImage8 image = renderer.frame(shown, 0);
  int lit = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      if (truth.reachable(x, y) == 0) continue;
      const float row = truth.rows(x, y);
      const float column = truth.columns(x, y);
      if (std::abs(row - 299.5F) < 6 || std::abs(column - 599.5F) < 6) continue;
      const bool wanted = row < 299.5F && column < 599.5F;
      ASSERT_EQ(green(image, x, y) > 0.3, wanted) << x << ' ' << y;
      lit += wanted ? 1 : 0;
    }
  }
  EXPECT_GT(lit, 3000);
}

TEST(Renderer, GainMultipliesTheLight) {
  const Scene scene = shaded_plate();
  const Renderer renderer = Renderer::make(scene, quiet_options()).value();
  const auto [x, y] = pixel_of(scene, Vector3d(150, 0, 1050));
  const FloatImage full(scene.calibration.projector.size, 1);
  const double once = green(renderer.frame(full, 0), x, y);
  EXPECT_NEAR(green(renderer.frame(full, 0, 0.25F), x, y), once / 4, 0.004);
  EXPECT_EQ(green(renderer.frame(full, 0, 4), x, y), 1);
}

TEST(Renderer, MotionShiftsLaterFrames) {
  Scene scene;
  RenderOptions options = quiet_options();
  scene.calibration = make_rig(options.rig).value();
  append_rectangle(scene.subject.mesh, Vector3d(0, 0, 1050), Vector3d(50, 0, 0), Vector3d(0, 50, 0));
  options.motion = {4, 0, 0};
  const Renderer renderer = Renderer::make(scene, options).value();
  const auto right_edge = [&](int index) {
    const ColorImage8 image = renderer.frame(white, index);
    const int y = image.height() / 2;
    double sum = 0;
    for (int x = image.width() / 2; x < image.width(); ++x) sum += green(image, x, y) > 0.3 ? 1 : 0;
    return sum;
  };
  const double px_per_mm = scene.calibration.camera.fx / 1050;
  EXPECT_NEAR(right_edge(5) - right_edge(0), 20 * px_per_mm, 1.5);
}

}  // namespace
}  // namespace bodyscan::simulator
