#include "pipeline/geometry/lens.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

// A wide-angle lens with all five coefficients.
const Lens wide{{1280, 1024}, 1100, 1080, 650.5, 500.25, {-0.24, 0.09, 0.0008, -0.0012, -0.015}};

TEST(Lens, WithoutDistortionIsAPinhole) {
  const Lens pinhole{{640, 480}, 500, 400, 320, 240, {}};
  const Eigen::Vector2d pixel = pinhole.project({0.2, -0.1, 2});
  EXPECT_NEAR(pixel.x(), 370, 1e-12);
  EXPECT_NEAR(pixel.y(), 220, 1e-12);
  EXPECT_TRUE(pinhole.ray({370, 220}).isApprox(Eigen::Vector3d(0.1, -0.05, 1), 1e-12));
}

// Figures from cv::projectPoints (OpenCV 4.6).
struct Projected {
  Eigen::Vector3d point;
  Eigen::Vector2d pixel;
};

TEST(Lens, DistortsAsOpenCvDoes) {
  const std::vector<Projected> expected = {
      {{0, 0, 900}, {650.5, 500.25}},
      {{310, -220, 900}, {1013.522906456859, 247.295063027909}},
      {{-350, 290, 800}, {201.053624619338, 865.809809569411}},
      {{120, 333, 1000}, {778.580366849855, 849.769620372886}},
      {{-400, -320, 950}, {215.705835351346, 159.291600690572}},
  };
  for (const auto& [point, pixel] : expected)
    EXPECT_NEAR((wide.project(point) - pixel).norm(), 0, 1e-9) << point.transpose();
}

TEST(Lens, UndistortIsTheInverseAllOverTheImage) {
  for (int y = 0; y < wide.size.height; y += 31) {
    for (int x = 0; x < wide.size.width; x += 31) {
      const Eigen::Vector2d pixel(x, y);
      const Eigen::Vector3d ray = wide.ray(pixel);
      EXPECT_NEAR((wide.project(700 * ray) - pixel).norm(), 0, 1e-9) << x << ' ' << y;
      EXPECT_EQ(ray.z(), 1);
    }
  }
}

TEST(Lens, TangentialTermsBreakTheSymmetry) {
  const Lens lens{{640, 480}, 500, 500, 320, 240, {0, 0, 0.01, 0, 0}};
  // p1: y gains p1 (r2 + 2 y2), x gains 2 p1 x y
  const Eigen::Vector2d distorted = lens.distort({0.3, 0.2});
  EXPECT_NEAR(distorted.x(), 0.3 + 2 * 0.01 * 0.06, 1e-15);
  EXPECT_NEAR(distorted.y(), 0.2 + 0.01 * (0.13 + 0.08), 1e-15);
}

}  // namespace
}  // namespace bodyscan
