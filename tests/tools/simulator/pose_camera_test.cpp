#include "tools/simulator/pose_camera.hpp"

#include "tests/tools/simulator/session_test_support.hpp"
#include "tools/simulator/blunders.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace bodyscan::simulator {
namespace {

using Eigen::Vector2d;

constexpr Pattern white{.kind = PatternKind::white};

bool same(const ColorImage8& a, const ColorImage8& b) {
  return std::equal(a.pixels().begin(), a.pixels().end(), b.pixels().begin());
}

// The projector's own light alone.
RenderOptions direct_light() {
  RenderOptions options = small_session(SessionMethod::projected).render;
  options.ambient = 0;
  options.reflection = 0;
  return options;
}

class PoseCameraTest : public testing::Test {
 protected:
  [[nodiscard]] PoseCamera camera(const RenderOptions& options, int number = 0) const {
    return PoseCamera::make(truth_.calibration, pose_, number, options).value();
  }
  void plant_blunder(Blunder kind) { plant(kind, truth_.calibration, pose_); }

  // In the middle of a square of the board; (0, 0) is the one beyond corner (0, 0).
  [[nodiscard]] Vector2d square_pixel(int column, int row) const {
    const Vector2d paper = 25 * (Vector2d(column, row).array() - 0.5);
    return truth_.calibration.camera.project(pose_.first_camera_from_board * pose_.sheet.point(paper));
  }
  [[nodiscard]] double square_light(const ColorImage8& image, int column, int row) const {
    const Vector2d pixel = square_pixel(column, row);
    return green_light(image, static_cast<int>(std::lround(pixel.x())),
                       static_cast<int>(std::lround(pixel.y())));
  }
  [[nodiscard]] double edge_error(const ColorImage8& image, const RigidTransform& camera_from_board) const {
    return largest_edge_error(image, truth_.calibration.camera, pose_.sheet, camera_from_board);
  }
  // Pictures in even light, whatever the pose's is.
  [[nodiscard]] PoseCamera even_camera() {
    pose_.first_light = pose_.second_light = 0;
    return camera(even_light(direct_light()));
  }

  SessionTruth truth_ = plan_session(small_session(SessionMethod::projected)).value();
  SessionPose pose_ = truth_.poses[0];
};

TEST_F(PoseCameraTest, ThePrintedBoardIsInItsPose) {
  for (const SessionPose& pose : truth_.poses) {
    pose_ = pose;
    const PoseCamera still = even_camera();
    EXPECT_LT(edge_error(still.take(white, 0), pose.first_camera_from_board), 0.07);
    EXPECT_TRUE(same(still.take(white, 0), still.take(white, 1)));
  }
}

TEST_F(PoseCameraTest, TheProjectedBoardIsWhereItsCornersAreSaidToBe) {
  // On next to bare white, flat and bent to 0.9 m; over the white picture the light is even.
  for (const double bend : {0.0, 0.005}) {
    pose_.sheet = PrintedSheet({3, 3, 1}, {.bend_mm = bend, .plate_mm = 500, .edge_mm = 0});
    pose_.first_camera_from_board.translation = pose_.second_camera_from_board.translation = {0, 0, 1050};
    const PoseCamera still = camera(direct_light());
    const ColorImage8 lit = still.take(white, 0);
    const ColorImage8 projected = still.take(truth_.projected, 1);
    const double error = largest_edge_error(
        9, 7, [&](int x, int y) { return green_light(projected, x, y) / green_light(lit, x, y); },
        [&](double column, double row) {
          ProjectedBoard place = truth_.projected;
          place.columns = place.rows = 1;
          place.first_corner_px += place.square_px * Vector2d(column, row);
          const auto corners =
              projected_corners(truth_.calibration, place, pose_.sheet, pose_.second_camera_from_board);
          return corners.empty() ? Vector2d(50, 50) : truth_.calibration.camera.project(corners[0]);
        });
    EXPECT_LT(error, 0.1) << bend;
  }
}

TEST_F(PoseCameraTest, ThePoseSetsTheLight) {
  const double light = square_light(camera(direct_light()).take(white, 0), 4, 3);
  pose_.first_light = pose_.second_light = 0.5 * pose_.first_light;
  RenderOptions options = direct_light();
  options.light = 50;
  EXPECT_NEAR(square_light(camera(options).take(white, 0), 4, 3) / light, 0.5, 0.01);
}

TEST_F(PoseCameraTest, UnevenLightFallsLinearlyAcrossTheProjectorsPicture) {
  RenderOptions options = direct_light();
  const ColorImage8 even = camera(options).take(white, 0);
  options.uneven_light = 0.6;
  const ColorImage8 uneven = camera(options).take(white, 0);
  double darkest = 1;
  double brightest = 0;
  for (int row = 0; row <= 7; ++row) {
    for (int column = 1 - row % 2; column <= 9; column += 2) {  // white squares
      const Vector2d pixel = square_pixel(column, row).array().round();
      const Eigen::Vector3d board_z = pose_.first_camera_from_board.rotation.col(2);
      const Eigen::Vector3d ray = truth_.calibration.camera.ray(pixel);
      const Eigen::Vector3d point =
          board_z.dot(pose_.first_camera_from_board.translation) / board_z.dot(ray) * ray;
      const Vector2d lit =
          truth_.calibration.projector.project(truth_.calibration.projector_from_camera * point);
      const double wanted = 1 - 0.6 * (lit.x() / 255 + lit.y() / 191) / 2;
      const double share = square_light(uneven, column, row) / square_light(even, column, row);
      EXPECT_NEAR(share, wanted, 0.02) << column << ' ' << row;
      darkest = std::min(darkest, share);
      brightest = std::max(brightest, share);
    }
  }
  EXPECT_GT(brightest - darkest, 0.1);
}

TEST_F(PoseCameraTest, NoiseIsOfTheElectronsAndEachPicturesAndPosesOwn) {
  RenderOptions options = direct_light();
  const ColorImage8 clean = camera(options).take(white, 0);
  options.full_well = 3000;
  options.read_noise = 20;
  const PoseCamera noisy = camera(options, 2);
  const ColorImage8 image = noisy.take(white, 0);
  EXPECT_TRUE(same(image, camera(options, 2).take(white, 0)));
  EXPECT_FALSE(same(image, noisy.take(white, 1)));
  EXPECT_FALSE(same(image, camera(options, 3).take(white, 0)));
  options.seed = 2;
  EXPECT_FALSE(same(image, camera(options, 2).take(white, 0)));

  double squares = 0;
  int count = 0;
  for (int y = 0; y < clean.height(); ++y) {
    for (int x = 0; x < clean.width(); ++x) {
      const double light = green_light(clean, x, y);
      if (light < 0.3 || light > 0.7) continue;
      const double electrons = 3000 * (green_light(image, x, y) - light);
      squares += electrons * electrons / (3000 * light + 400);
      ++count;
    }
  }
  ASSERT_GT(count, 10000);
  EXPECT_NEAR(std::sqrt(squares / count), 1, 0.03);
}

TEST_F(PoseCameraTest, LensBlurSpreadsEdgesByItsWidthAndKeepsTheLight) {
  // Faces the camera; the edge between two squares in the picture's middle is upright.
  pose_.first_camera_from_board = {Eigen::Matrix3d::Identity(), {-100, -75, 1050}};
  pose_.second_camera_from_board = pose_.first_camera_from_board;
  const Lens& lens = truth_.calibration.camera;
  const Vector2d edge = lens.project(pose_.first_camera_from_board * Eigen::Vector3d(100, 62.5, 0));
  const int row = static_cast<int>(std::lround(edge.y()));
  const auto variance_and_mean = [&](double sigma) {
    pose_.lens_blur = sigma;
    const ColorImage8 image = camera(direct_light()).take(white, 0);
    double sum = 0;
    double squares = 0;
    for (int x = static_cast<int>(edge.x()) - 7; x < edge.x() + 6; ++x) {
      const double step = green_light(image, x + 1, row) - green_light(image, x, row);
      sum += step;
      squares += step * (x + 0.5 - edge.x()) * (x + 0.5 - edge.x());
    }
    double mean = 0;
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x)
        mean += green_light(image, x, y) / static_cast<double>(image.size().area());
    }
    return std::pair(squares / sum, mean);
  };
  const auto [sharp_variance, sharp_mean] = variance_and_mean(0);
  const auto [blurred_variance, blurred_mean] = variance_and_mean(1.4);
  EXPECT_LT(sharp_variance, 0.3);
  EXPECT_NEAR(std::sqrt(blurred_variance - sharp_variance), 1.4, 0.05);
  EXPECT_NEAR(blurred_mean / sharp_mean, 1, 0.002);
}

TEST_F(PoseCameraTest, AMovedBoardIsInItsSecondPlaceFromTheSecondPictureOn) {
  plant_blunder(Blunder::moved);
  const PoseCamera moved = even_camera();
  EXPECT_LT(edge_error(moved.take(white, 0), pose_.first_camera_from_board), 0.07);
  for (const int index : {1, 2})
    EXPECT_LT(edge_error(moved.take(white, index), pose_.second_camera_from_board), 0.07);
  EXPECT_GT(edge_error(moved.take(white, 1), pose_.first_camera_from_board), 1);
}

TEST_F(PoseCameraTest, ADarkPoseIsDarkFromTheSecondPictureOn) {
  const ColorImage8 sound = camera(direct_light()).take(white, 0);
  plant_blunder(Blunder::dark);
  const PoseCamera dark = camera(direct_light());
  EXPECT_TRUE(same(dark.take(white, 0), sound));
  EXPECT_NEAR(square_light(dark.take(white, 1), 4, 3), 0.02 * square_light(sound, 4, 3), 0.001);
}

TEST_F(PoseCameraTest, AnOverexposedPoseLosesItsWhite) {
  plant_blunder(Blunder::overexposed);
  const ColorImage8 image = camera(direct_light()).take(white, 0);
  EXPECT_EQ(square_light(image, 4, 3), 1);
  EXPECT_LT(square_light(image, 4, 4), 0.5);
}

TEST_F(PoseCameraTest, ExchangedBoardsAreInThePicture) {
  for (const Blunder kind : {Blunder::size, Blunder::scaled}) {
    pose_ = truth_.poses[0];
    plant_blunder(kind);
    EXPECT_LT(edge_error(even_camera().take(white, 0), pose_.first_camera_from_board), 0.07);
  }
}

}  // namespace
}  // namespace bodyscan::simulator
