#include "tests/pipeline/decode/synthetic_capture.hpp"

#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

struct Case {
  const char* name;
  CaptureOptions capture;
  double turn_degrees = 0;
  double px_per_row = 2.7;
  double max_rms = 0.01;  // projector px
};

constexpr SequenceOptions rows_only{.rows = true, .columns = false, .inverses = true};
constexpr SequenceOptions columns_only{.rows = false, .columns = true, .inverses = true};
constexpr SequenceOptions both{.rows = true, .columns = true, .inverses = true};
constexpr SequenceOptions no_inverses{.rows = true, .columns = true, .inverses = false};
constexpr ToneResponse linear{ToneResponse::Kind::linear, 1};
constexpr ToneResponse gamma_2_2{ToneResponse::Kind::gamma, 2.2};

void PrintTo(const Case& tested, std::ostream* out) {
  *out << tested.name;
}

class CleanCapture : public testing::TestWithParam<Case> {};

TEST_P(CleanCapture, IsLocatedToAHundredthOfAPixel) {
  const Case& tested = GetParam();
  const Scene scene = plane_scene(tested.capture, tested.turn_degrees, tested.px_per_row);
  const Correspondence found = decode(scene, tested.capture);
  EXPECT_EQ(found.camera, tested.capture.camera);
  EXPECT_EQ(found.projector, tested.capture.projector);
  EXPECT_EQ(found.rows.has_value(), tested.capture.sequence.rows);
  EXPECT_EQ(found.columns.has_value(), tested.capture.sequence.columns);
  const auto check = [&](const std::optional<AxisCorrespondence>& axis, Axis which) {
    if (!axis) return;
    const Comparison result = compare(*axis, which, scene, interior(tested.capture.camera));
    EXPECT_EQ(result.undecided, 0);
    EXPECT_LT(result.rms, tested.max_rms);
    EXPECT_LT(result.worst, 4 * tested.max_rms);
    EXPECT_LT(std::abs(result.mean), 0.1 * tested.max_rms);
  };
  check(found.rows, Axis::row);
  check(found.columns, Axis::column);
  EXPECT_EQ(found.pixels_decoded, tested.capture.camera.area());
  EXPECT_EQ(found.pixels_lit, tested.capture.camera.area());
}

INSTANTIATE_TEST_SUITE_P(
    Decoder, CleanCapture,
    testing::Values(
        Case{"rows", {.sequence = rows_only}}, Case{"columns", {.sequence = columns_only}},
        Case{"rows_and_columns_16_bit", {.sequence = both, .bits = 16}},
        Case{"turned_30", {.sequence = both}, 30, 2.7, 0.004},
        Case{"turned_30_16_bit", {.bits = 16}, 30, 2.7, 0.002}, Case{"turned_90", {.sequence = both}, 90},
        Case{"turned_180", {}, 180}, Case{"turned_250", {.sequence = both}, 250, 2.7, 0.004},
        Case{"few_pixels_a_row", {}, 30, 1.7}, Case{"many_pixels_a_row", {}, 30, 6},
        Case{"no_inverses", {.sequence = no_inverses}, 30},
        Case{"no_inverses_16_bit", {.sequence = no_inverses, .bits = 16}, 120, 2.7, 0.004},
        Case{"linear_8_bit", {.response = linear}, 30},
        Case{"linear_16_bit", {.response = linear, .bits = 16}, 30, 2.7, 0.002},
        Case{"gamma_16_bit", {.response = gamma_2_2, .bits = 16}, 30, 2.7, 0.002},
        Case{"rows_600", {.projector = {800, 600}}, 30}, Case{"rows_1080", {.projector = {1920, 1080}}, 30},
        Case{"rows_37", {.projector = {64, 37}}, 30, 12}, Case{"odd_camera", {.camera = {251, 187}}, 30}),
    [](const auto& tested) { return tested.param.name; });

DecodeOptions responding(ToneResponse response) {
  DecodeOptions options;
  options.response = response;
  return options;
}

// Half of white and black is where a stripe's edge lies in linear light only; an inverse crosses there in
// any.
TEST(Decoder, AWrongResponseCostsAccuracyWithoutInverses) {
  const CaptureOptions options{.sequence = no_inverses, .response = gamma_2_2, .bits = 16};
  const Scene scene = plane_scene(options, 30);
  const auto frames = capture(scene, options);
  const auto error = [&](ToneResponse response) {
    const Correspondence found = decode(frames, sequence_of(options), responding(response));
    return compare(*found.rows, Axis::row, scene, interior(options.camera)).rms;
  };
  EXPECT_LT(error(gamma_2_2), 0.002);
  EXPECT_GT(error(linear), 0.02);
}

class UnknownResponse : public testing::TestWithParam<ToneResponse> {};

TEST_P(UnknownResponse, IsFoundInTheCapture) {
  const ToneResponse actual = GetParam();
  const CaptureOptions options{.response = actual, .ambient = 0.05};
  const Scene scene = [plane = plane_scene(options, 30)](int x, int y) {
    Sight sight = plane(x, y);
    if (std::hypot(x - 128, y - 96) < 30) sight.albedo = 0.35;
    return sight;
  };
  const Correspondence found = decode(capture(scene, options), sequence_of(options), {});
  EXPECT_EQ(found.response.kind, actual.kind);
  EXPECT_NEAR(found.response.gamma, actual.gamma, 0.1);
  EXPECT_LT(compare(*found.rows, Axis::row, scene, interior(options.camera)).rms, 0.01);
}

// The two coarsest bits have no edge on this scene, so the response is settled after both.
TEST_P(UnknownResponse, FoundLateStillHasItsNoiseMeasured) {
  CaptureOptions options{.response = GetParam(), .bits = 16, .ambient = 0.05};
  options.read_noise = 0.004;
  const Scene scene = plane_scene(options, 30);
  DecodeOptions decoding;
  decoding.fit.half_width_px = 0;
  const Correspondence found = decode(capture(scene, options), sequence_of(options), decoding);
  const Comparison comparison = compare(*found.rows, Axis::row, scene, interior(options.camera));
  EXPECT_NEAR(std::log(comparison.rms / comparison.mean_sigma), 0, std::log(1.5));
}

std::string name_of_response(const testing::TestParamInfo<ToneResponse>& tested) {
  constexpr std::array names{"srgb", "linear", "gamma"};
  return names[static_cast<std::size_t>(tested.param.kind)];
}

INSTANTIATE_TEST_SUITE_P(Decoder, UnknownResponse,
                         testing::Values(ToneResponse{}, linear,
                                         ToneResponse{ToneResponse::Kind::gamma, 1.5}),
                         name_of_response);

TEST(Decoder, CoordinatesRiseSteadilyAcrossEveryStripeEdge) {
  const CaptureOptions options{.bits = 16};
  DecodeOptions decoding;
  decoding.fit.half_width_px = 0;
  const Correspondence found = decode(plane_scene(options), options, decoding);
  for (int y = 1; y < options.camera.height; ++y) {
    for (int x = 0; x < options.camera.width; ++x) {
      const double step = found.rows->coordinate(x, y) - found.rows->coordinate(x, y - 1);
      ASSERT_NEAR(step, 1 / 2.7, 0.05) << x << ' ' << y;
    }
  }
}

struct Light {
  double albedo;
  bool inverses;
  bool fitted;
};

class PredictedSigma : public testing::TestWithParam<Light> {};

TEST_P(PredictedSigma, AgreesWithTheActualError) {
  const Light& light = GetParam();
  CaptureOptions options{.read_noise = 0.003, .shot_noise = 2e-5};
  options.sequence.inverses = light.inverses;
  const Scene plane = plane_scene(options, 30);
  const Scene scene = [&](int x, int y) {
    Sight sight = plane(x, y);
    sight.albedo = light.albedo;
    return sight;
  };
  DecodeOptions decoding;
  if (!light.fitted) decoding.fit.half_width_px = 0;
  const Correspondence found = decode(scene, options, decoding);
  const Comparison result = compare(*found.rows, Axis::row, scene, interior(options.camera));
  EXPECT_LT(result.undecided, 0.005 * result.pixels);
  EXPECT_LT(result.rms / result.mean_sigma, 1.5);
  EXPECT_GT(result.rms / result.mean_sigma, 1 / 1.5);
}

INSTANTIATE_TEST_SUITE_P(Decoder, PredictedSigma,
                         testing::Values(Light{0.06, true, false}, Light{0.06, true, true},
                                         Light{0.15, true, true}, Light{0.15, false, false},
                                         Light{0.4, true, false}, Light{0.4, true, true},
                                         Light{0.8, true, true}, Light{0.8, false, true}),
                         [](const auto& tested) {
                           return "albedo_" + std::to_string(std::lround(100 * tested.param.albedo)) +
                                  (tested.param.inverses ? "" : "_no_inverses") +
                                  (tested.param.fitted ? "_fitted" : "");
                         });

}  // namespace
}  // namespace bodyscan
