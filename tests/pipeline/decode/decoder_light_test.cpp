// Light that is not as simple as a bright, sharp, evenly coloured plane.
#include "tests/pipeline/decode/synthetic_capture.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

constexpr double px_per_row = 2.7;

struct Disc {
  double x;
  double y;
  double radius;
  [[nodiscard]] double depth_of(int px, int py) const { return radius - std::hypot(px - x, py - y); }
};

Scene changed(const Scene& base, const std::function<void(int, int, Sight&)>& change) {
  return [=](int x, int y) {
    Sight sight = base(x, y);
    change(x, y, sight);
    return sight;
  };
}

TEST(DecoderBlur, FinestBitsAreDroppedWhereTheyVanishAndOnlyThere) {
  const CaptureOptions options{.camera = {384, 192}, .read_noise = 0.004, .shot_noise = 2e-5};
  const Scene scene = changed(plane_scene(options, 30), [](int x, int, Sight& sight) {
    if (x >= 192) sight.blur_px = 1.6;
  });
  const auto inside = interior(options.camera);
  const auto sharp = [&](int x, int y) { return inside(x, y) && x < 80; };
  const auto blurred = [&](int x, int y) { return inside(x, y) && x >= 304; };

  const Correspondence found = decode(scene, options);
  const Comparison at_sharp = compare(*found.rows, Axis::row, scene, sharp);
  const Comparison at_blurred = compare(*found.rows, Axis::row, scene, blurred);
  EXPECT_EQ(at_sharp.undecided, 0);
  EXPECT_EQ(at_blurred.undecided, 0);
  EXPECT_LT(at_sharp.rms, 0.02);
  EXPECT_LT(at_blurred.rms, 0.02);
  const Comparison everywhere = compare(*found.rows, Axis::row, scene, inside);
  EXPECT_LT(everywhere.undecided, 0.02 * everywhere.pixels);
  EXPECT_LT(everywhere.worst, 1);  // no wrong stripe, not even where sharp meets blurred

  // Each pixel on its own, or the fit over noisy pixels would hide it.
  DecodeOptions alone;
  alone.fit.half_width_px = 0;
  const double dropped = compare(*decode(scene, options, alone).rows, Axis::row, scene, blurred).rms;
  alone.max_dropped_bits = 0;
  EXPECT_GT(compare(*decode(scene, options, alone).rows, Axis::row, scene, blurred).rms, 3 * dropped);
}

class WholeBlur : public testing::TestWithParam<double> {};

TEST_P(WholeBlur, IsDecodedWholly) {
  const double blur = GetParam();
  const CaptureOptions options{.read_noise = 0.004, .shot_noise = 2e-5};
  const Scene scene =
      changed(plane_scene(options, 30), [&](int, int, Sight& sight) { sight.blur_px = blur; });
  const Correspondence found = decode(scene, options);
  const Comparison result = compare(*found.rows, Axis::row, scene, interior(options.camera));
  EXPECT_EQ(result.undecided, 0);
  EXPECT_LT(result.rms, 0.004 + 0.005 * blur);
}

INSTANTIATE_TEST_SUITE_P(DecoderBlur, WholeBlur, testing::Values(0.3, 0.6, 0.9, 1.2, 1.6, 2.0, 2.5));

TEST(DecoderScattering, LightSpreadUnderTheSkinDoesNotMoveTheStripes) {
  const CaptureOptions options;
  const Scene scene =
      changed(plane_scene(options, 30), [](int, int, Sight& sight) { sight.wide_share = 0.5; });
  const Correspondence found = decode(scene, options);
  const Comparison result = compare(*found.rows, Axis::row, scene, interior(options.camera));
  EXPECT_EQ(result.undecided, 0);
  EXPECT_LT(result.rms, 0.01);
}

struct ScatteredLight {
  double share;
  double row;
  double spread_px;
  double read_noise;
  double max_wrong;  // share of the shadow's pixels
};

class Shadow : public testing::TestWithParam<ScatteredLight> {};

TEST_P(Shadow, LitByOtherSurfacesOnlyIsUndecided) {
  const ScatteredLight& light = GetParam();
  const CaptureOptions options{.read_noise = light.read_noise};
  const Disc shadow{128, 96, 40};
  const Scene scene = changed(plane_scene(options, 30), [&](int x, int y, Sight& sight) {
    sight.scattered = light.share;
    sight.scattered_row = light.row;
    sight.scattered_px = light.spread_px;
    sight.shadow = shadow.depth_of(x, y) > 0;
  });
  const Correspondence found = decode(scene, options);
  const Comparison inside =
      compare(*found.rows, Axis::row, scene, [&](int x, int y) { return shadow.depth_of(x, y) > 0; });
  EXPECT_LE(inside.pixels, light.max_wrong * (inside.pixels + inside.undecided));
  // Brighter than the threshold all the same: it was the stripes that told.
  EXPECT_EQ(found.pixels_lit, options.camera.area());

  const Comparison outside = compare(*found.rows, Axis::row, scene, [&](int x, int y) {
    return interior(options.camera)(x, y) && shadow.depth_of(x, y) <= 0;
  });
  EXPECT_EQ(outside.undecided, 0);
  EXPECT_LT(outside.rms, 0.01);
}

INSTANTIATE_TEST_SUITE_P(DecoderScattering, Shadow,
                         testing::Values(ScatteredLight{0.12, 400, 60, 0, 0},
                                         ScatteredLight{0.12, 300, 20, 0, 0},
                                         ScatteredLight{0.12, 100, 60, 0, 0},
                                         ScatteredLight{0.12, 384, 200, 0, 0},
                                         ScatteredLight{0.12, 400, 60, 0.004, 0.01}));

TEST(DecoderScattering, TheShareOfDirectLightAskedForDecides) {
  const CaptureOptions options;
  const Scene scene = changed(plane_scene(options, 30), [](int x, int, Sight& sight) {
    // a tenth of the light is direct in the right half, all of it in the left
    if (x < 128) return;
    sight.wide_share = 0.9;
    sight.wide_px = 100;
  });
  const auto decided = [&](float share) {
    DecodeOptions decoding;
    decoding.min_direct_share = share;
    const Correspondence found = decode(scene, options, decoding);
    return compare(*found.rows, Axis::row, scene, [](int x, int y) { return x >= 150 && y > 10 && y < 182; })
        .pixels;
  };
  EXPECT_GT(decided(0.02F), 90 * 170);
  EXPECT_EQ(decided(0.4F), 0);
}

TEST(DecoderDarkness, PixelsWithoutTheProjectorsLightAreNeitherLitNorDecoded) {
  const CaptureOptions options;
  const Disc dark{128, 96, 30};
  const Scene scene = changed(plane_scene(options, 30), [&](int x, int y, Sight& sight) {
    if (dark.depth_of(x, y) > 0) sight.albedo = 0.001;
  });
  const Correspondence found = decode(scene, options);
  const Comparison inside =
      compare(*found.rows, Axis::row, scene, [&](int x, int y) { return dark.depth_of(x, y) > 0; });
  EXPECT_EQ(inside.pixels, 0);
  EXPECT_EQ(found.pixels_lit, options.camera.area() - static_cast<std::size_t>(inside.undecided));
  EXPECT_EQ(found.pixels_decoded, found.pixels_lit);
}

TEST(DecoderDarkness, BeyondTheProjectorsEdgeNothingIsDecoded) {
  CaptureOptions options{.projector = {64, 37}};
  const Scene scene = plane_scene(options, 0, 4);  // 48 rows of picture, 37 of projector
  const Correspondence found = decode(scene, options);
  const auto row_at = [&](int x, int y) { return scene(x, y).row; };
  EXPECT_EQ(compare(*found.rows, Axis::row, scene,
                    [&](int x, int y) { return row_at(x, y) < -1.5 || row_at(x, y) > 37.5; })
                .pixels,
            0);
  const Comparison lit = compare(*found.rows, Axis::row, scene,
                                 [&](int x, int y) { return row_at(x, y) > 1.5 && row_at(x, y) < 34.5; });
  EXPECT_EQ(lit.undecided, 0);
  EXPECT_LT(lit.worst, 0.1);
  // The first and the last row lack an edge: nothing is better than a guess.
  EXPECT_LT(compare(*found.rows, Axis::row, scene, [](int, int) { return true; }).worst, 0.3);
}

TEST(DecoderDarkness, StripesThatDrownInNoiseAreUndecided) {
  const CaptureOptions options{.read_noise = 0.006};
  const Scene scene = changed(plane_scene(options, 30), [&](int, int, Sight& sight) { sight.albedo = 0.03; });
  const auto wrong = [&](float min_signal_to_noise) {
    DecodeOptions decoding;
    decoding.min_signal_to_noise = min_signal_to_noise;
    const Correspondence found = decode(scene, options, decoding);
    int count = 0;
    for (int y = 0; y < options.camera.height; ++y)
      for (int x = 0; x < options.camera.width; ++x)
        count += std::abs(found.rows->coordinate(x, y) - scene(x, y).row) > 3;
    return count;
  };
  EXPECT_LT(wrong(8), 0.1 * wrong(0));
}

TEST(DecoderAlbedo, MolesAndStepsInColourLeaveTheCoordinateAlone) {
  const CaptureOptions options;
  const std::vector<Disc> moles{{80, 96, 12}, {180, 60, 4}};
  const Scene scene = changed(plane_scene(options, 30), [&](int x, int y, Sight& sight) {
    for (const Disc& mole : moles)
      if (mole.depth_of(x, y) > 0) sight.albedo = 0.35;
    if (x > 210) sight.albedo = 0.4;
  });
  const Correspondence found = decode(scene, options);
  const Comparison at_moles = compare(*found.rows, Axis::row, scene, [&](int x, int y) {
    return moles[0].depth_of(x, y) > -3 || moles[1].depth_of(x, y) > -3;
  });
  EXPECT_EQ(at_moles.undecided, 0);
  EXPECT_LT(at_moles.rms, 0.01);
  EXPECT_LT(at_moles.worst, 0.03);
}

TEST(DecoderAlbedo, PixelsLitByABrightNeighbourMayBeUndecidedButNotWrong) {
  const CaptureOptions options{.camera_blur = 0.5};
  const Disc dark{128, 96, 30};
  const Scene scene = changed(plane_scene(options, 30), [&](int x, int y, Sight& sight) {
    if (dark.depth_of(x, y) > 0) sight.albedo = 0.08;
  });
  const Correspondence found = decode(scene, options);
  const auto elsewhere = [&](int x, int y) {
    return interior(options.camera)(x, y) && (dark.depth_of(x, y) < -0.5 || dark.depth_of(x, y) > 4);
  };
  EXPECT_EQ(compare(*found.rows, Axis::row, scene, elsewhere).undecided, 0);
  EXPECT_LT(compare(*found.rows, Axis::row, scene, interior(options.camera)).worst, 0.1);
}

TEST(DecoderAlbedo, TheCamerasBlurDoesNotBendTheSurfaceAtABrightnessEdge) {
  const CaptureOptions options{.bits = 16, .read_noise = 0.002, .camera_blur = 0.8};
  const Disc mole{128, 96, 30};
  const Scene scene = changed(plane_scene(options, 30), [&](int x, int y, Sight& sight) {
    if (mole.depth_of(x, y) > 0) sight.albedo = 0.35;
  });
  const Correspondence found = decode(scene, options);
  const Comparison at_edge =
      compare(*found.rows, Axis::row, scene, [&](int x, int y) { return std::abs(mole.depth_of(x, y)) < 3; });
  EXPECT_LT(at_edge.undecided, 0.05 * at_edge.pixels);
  EXPECT_LT(at_edge.rms, 0.007);
}

TEST(DecoderDepthJump, NothingIsSmoothedAcrossIt) {
  const CaptureOptions options{.read_noise = 0.001};
  const Scene scene = changed(plane_scene(options), [](int x, int, Sight& sight) {
    if (x >= 128) sight.row += 7.3;
  });
  const Correspondence found = decode(scene, options);
  const Comparison at_jump = compare(*found.rows, Axis::row, scene,
                                     [](int x, int y) { return x >= 125 && x <= 130 && y > 10 && y < 182; });
  EXPECT_EQ(at_jump.undecided, 0);
  EXPECT_LT(at_jump.worst, 0.05);
}

TEST(DecoderRelief, ASmallBumpKeepsItsHeight) {
  const CaptureOptions options{.read_noise = 0.001};
  const Disc bump{120, 100, 3 * px_per_row};
  const Scene scene = changed(plane_scene(options, 30), [&](int x, int y, Sight& sight) {
    const double depth = bump.depth_of(x, y);
    if (depth > 0) sight.row += 0.2 * (1 - std::cos(M_PI * depth / bump.radius));
  });
  const Correspondence found = decode(scene, options);
  const auto centre = [&](int x, int y) { return bump.depth_of(x, y) > bump.radius - 1.5; };
  EXPECT_LT(std::abs(compare(*found.rows, Axis::row, scene, centre).mean), 0.1 * 0.4);
}

}  // namespace
}  // namespace bodyscan
