#include "pipeline/decode/camera_blur.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

constexpr Size camera{240, 180};
constexpr double slope = 0.5;  // projector px a camera px
constexpr double dark = 800;
constexpr double white = 8000;

// Squares of 31 px, blurred by a Gaussian of variance s2; coordinates that the blur has bent.
struct BlurredBoard {
  BlurredBoard(double s2, double contrast_noise, double coordinate_noise, bool across)
      : contrast(camera), coordinate(camera), sigma(camera, static_cast<float>(coordinate_noise)) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    const auto wave = [&](int pixel) { return std::erf(edge_distance(pixel) / std::sqrt(2 * s2)); };
    const auto wave_slope = [&](int pixel) {
      const double d = edge_distance(pixel);
      return std::sqrt(2 / (M_PI * s2)) * std::exp(-d * d / (2 * s2)) * direction(pixel);
    };
    for (int y = 0; y < camera.height; ++y) {
      for (int x = 0; x < camera.width; ++x) {
        const double sign_x = wave(x) * direction(x);
        const double sign_y = wave(y) * direction(y);
        const double light = (white + dark) / 2 + (white - dark) / 2 * sign_x * sign_y;
        const double grad = (white - dark) / 2 * (across ? wave_slope(x) * sign_y : sign_x * wave_slope(y));
        contrast(x, y) = static_cast<std::uint16_t>(std::lround(light + contrast_noise * normal(random)));
        coordinate(x, y) = static_cast<float>(100 + slope * (across ? x : y) + s2 * slope * grad / light +
                                              coordinate_noise * normal(random));
      }
    }
  }
  [[nodiscard]] CoordinateRows rows() const {
    return [this](const RowRange& rows, const RowArrays& arrays) {
      for (int i = 0; i < rows.count; ++i) {
        std::copy_n(coordinate.row(rows.camera_row(i)), camera.width, arrays.coordinate_row(i));
        std::copy_n(sigma.row(rows.camera_row(i)), camera.width, arrays.sigma_row(i));
      }
    };
  }

  Image<std::uint16_t> contrast;
  FloatImage coordinate;
  FloatImage sigma;

 private:
  // Edges lie between pixels, at 14.5 + 31 n.
  static int nearest_edge(int pixel) { return static_cast<int>(std::lround((pixel - 14.5) / 31)); }
  static double edge_distance(int pixel) { return pixel - 14.5 - 31 * nearest_edge(pixel); }
  static int direction(int pixel) { return nearest_edge(pixel) % 2 == 0 ? 1 : -1; }
};

CameraBlur measured_blur(const BlurredBoard& board, const NoiseModel& noise) {
  SampledRows sampled(camera);
  sampled.measure(board.rows());
  return measure_camera_blur(sampled, GradientMap(sampled, board.contrast), board.contrast, noise);
}

class Blur : public testing::TestWithParam<bool> {};

// Central differences flatten the steepest gradients, and s^2 makes up for it.
TEST_P(Blur, IsMeasured) {
  for (const double s2 : {0.4, 0.7, 1.0}) {
    const CameraBlur blur = measured_blur(BlurredBoard(s2, 0, 0.01, GetParam()), {1, 0});
    EXPECT_NEAR(blur.core, 1.15 * s2, 0.15 * s2) << s2;
    EXPECT_EQ(blur.tail, 0) << s2;
  }
}

// Real pictures showed it: a regressor's own noise pulls the slope towards zero.
TEST_P(Blur, IsMeasuredInNoiseToo) {
  const BlurredBoard board(0.6, 120, 0.05, GetParam());
  const CameraBlur blur = measured_blur(board, {120.0F * 120, 0});
  EXPECT_NEAR(blur.core + blur.tail, 0.6, 0.15);
}

TEST_P(Blur, WithoutEdgesIsZero) {
  BlurredBoard board(0.6, 0, 0.05, GetParam());
  std::mt19937 random(4);
  std::normal_distribution<double> normal(white, 120);
  for (auto& value : board.contrast.pixels()) value = static_cast<std::uint16_t>(normal(random));
  EXPECT_EQ(measured_blur(board, {120.0F * 120, 0}).core, 0);
}

TEST_P(Blur, IsTakenOffAndLeavesDoubt) {
  BlurredBoard board(0.6, 0, 0, GetParam());
  SampledRows sampled(camera);
  sampled.measure(board.rows());
  const GradientMap gradients(sampled, board.contrast);
  const int x = GetParam() ? 45 : 30;  // half a pixel from an edge
  const int y = GetParam() ? 30 : 45;
  const auto bend = [&] {
    return std::abs(board.coordinate(x, y) - static_cast<float>(100 + slope * (GetParam() ? x : y)));
  };
  const float before = bend();
  correct_camera_blur({0.6F, 0}, gradients, board.contrast, {0, camera.height},
                      {board.coordinate.data(), board.sigma.data(), camera.width});
  EXPECT_GT(before, 0.1F);
  EXPECT_LT(bend(), 0.35F * before);
  EXPECT_GT(board.sigma(x, y), 0.1F * before);
  EXPECT_LT(board.sigma(30, 30), 1e-4F);
}

TEST_P(Blur, HasATailWhereTheLensHas) {
  BlurredBoard board(0.6, 0, 0.005, GetParam());
  const int dx = GetParam() ? 3 : 0;
  const int dy = 3 - dx;
  for (int y = 3; y < camera.height - 3; ++y) {
    for (int x = 3; x < camera.width - 3; ++x) {
      const double gradient = (board.contrast(x + dx, y + dy) - board.contrast(x - dx, y - dy)) / 6.0;
      board.coordinate(x, y) += static_cast<float>(0.6 * slope * gradient / board.contrast(x, y));
    }
  }
  const CameraBlur blur = measured_blur(board, {1, 0});
  EXPECT_NEAR(blur.tail, 0.45, 0.15);
  EXPECT_NEAR(blur.core, 0.75, 0.2);
}

// The light of a surface that turns away falls further and further, and its coordinate bends all the same.
TEST_P(Blur, IsNotMistakenForCurvature) {
  BlurredBoard board(0.6, 0, 0.01, GetParam());
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const int pixel = (GetParam() ? x : y) % 60;
      const double fall = std::sqrt((60.5 - pixel) / 60);
      board.contrast(x, y) = static_cast<std::uint16_t>(white * fall);
      board.coordinate(x, y) = static_cast<float>(100 + slope * (GetParam() ? x : y) + 8 * fall);
    }
  }
  EXPECT_EQ(measured_blur(board, {1, 0}).core, 0);
}

INSTANTIATE_TEST_SUITE_P(Camera, Blur, testing::Bool(), [](const auto& instance) {
  return instance.param ? std::string("across") : std::string("down");
});

TEST(Gradients, AreThoseOfTheBrightPixels) {
  BlurredBoard board(0.6, 0, 0, false);
  // What is dark shows nonsense.
  for (std::size_t i = 0; i < camera.area(); ++i)
    if (board.contrast.data()[i] < white / 8) board.coordinate.data()[i] *= 3;
  SampledRows sampled(camera);
  sampled.measure(board.rows());
  const GradientMap gradients(sampled, board.contrast);
  for (int bx = 0; bx < gradients.columns(); ++bx) {
    EXPECT_NEAR(gradients.of_block(bx, 90).down, slope, 0.05);
    EXPECT_NEAR(gradients.of_block(bx, 90).across, 0, 0.05);
  }
  EXPECT_NEAR(gradients.px_per_unit(), 1 / slope, 0.15);
}

}  // namespace
}  // namespace bodyscan
