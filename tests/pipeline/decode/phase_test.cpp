// Sequences with phase steps, from frames to coordinates.
#include "pipeline/decode/decoder.hpp"
#include "tests/pipeline/decode/synthetic_capture.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

constexpr SequenceOptions fast_columns{
    .rows = false, .columns = true, .inverses = false, .phase = PhaseCode{}};
constexpr SequenceOptions fast_both{.rows = true, .columns = true, .inverses = false, .phase = PhaseCode{}};
constexpr ToneResponse linear{ToneResponse::Kind::linear, 1};
constexpr ToneResponse gamma_2_2{ToneResponse::Kind::gamma, 2.2};

SequenceOptions coded(int period_px, int steps, int finest_bit) {
  return {.phase = PhaseCode{.period_px = period_px, .steps = steps, .finest_bit = finest_bit}};
}

DecodeOptions unfitted() {
  DecodeOptions decoding;
  decoding.fit.half_width_px = 0;
  return decoding;
}

struct Case {
  const char* name;
  CaptureOptions capture;
  double turn_degrees = 0;
  double px_per_row = 2.7;
  double max_rms = 0.01;  // projector px
};

void PrintTo(const Case& tested, std::ostream* out) {
  *out << tested.name;
}

class CleanPhase : public testing::TestWithParam<Case> {};

TEST_P(CleanPhase, IsLocatedToAHundredthOfAPixel) {
  const Case& tested = GetParam();
  const Scene scene = plane_scene(tested.capture, tested.turn_degrees, tested.px_per_row);
  const Correspondence found = decode(scene, tested.capture);
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
}

INSTANTIATE_TEST_SUITE_P(
    Decoder, CleanPhase,
    testing::Values(Case{"rows", {.sequence = fast_sequence}}, Case{"columns", {.sequence = fast_columns}},
                    Case{"rows_and_columns", {.sequence = fast_both}, 30},
                    Case{"bits_16", {.sequence = fast_sequence, .bits = 16}, 30, 2.7, 0.003},
                    Case{"turned_180", {.sequence = fast_sequence}, 180},
                    Case{"few_pixels_a_row", {.sequence = fast_sequence}, 30, 1.7},
                    Case{"many_pixels_a_row", {.sequence = fast_sequence}, 30, 6},
                    Case{"linear_16_bit", {.sequence = fast_sequence, .response = linear, .bits = 16}, 30},
                    Case{"gamma_16_bit", {.sequence = fast_sequence, .response = gamma_2_2, .bits = 16}, 30},
                    Case{"rows_600", {.sequence = fast_sequence, .projector = {800, 600}}, 30},
                    Case{"rows_1080", {.sequence = fast_sequence, .projector = {1920, 1080}}, 30},
                    Case{"period_4", {.sequence = coded(4, 4, 1)}, 30, 2.7, 0.02},
                    Case{"period_7", {.sequence = coded(7, 7, 2)}, 30},
                    Case{"period_10", {.sequence = coded(10, 5, 2)}, 30},
                    Case{"period_6_cells_of_one", {.sequence = coded(6, 6, 0)}, 30},
                    Case{"odd_camera", {.camera = {251, 187}, .sequence = fast_sequence}, 30}),
    [](const auto& tested) { return tested.param.name; });

struct Blur {
  const char* name;
  double blur_px;
  double wide_share;
  double albedo;
  double read_noise;
};

void PrintTo(const Blur& tested, std::ostream* out) {
  *out << tested.name;
}

// A cell's edge and a period's end meet at every phase of the one within the other, five cells on.
class PhaseWrap : public testing::TestWithParam<Blur> {};

TEST_P(PhaseWrap, IsNeverOffByAPeriod) {
  const Blur& tested = GetParam();
  CaptureOptions options{.camera = {200, 400}, .sequence = fast_sequence, .read_noise = tested.read_noise};
  const Scene plane = plane_scene(options, 3, 2.7);
  const Scene scene = [&](int x, int y) {
    Sight sight = plane(x, y);
    sight.blur_px = tested.blur_px;
    sight.wide_share = tested.wide_share;
    sight.albedo = tested.albedo;
    return sight;
  };
  const Correspondence found = decode(scene, options, unfitted());
  const Comparison result = compare(*found.rows, Axis::row, scene, [](int, int) { return true; });
  EXPECT_LT(result.undecided, 0.001 * result.pixels);
  EXPECT_LT(result.worst, 2);
  EXPECT_LT(result.rms, 0.2);
}

INSTANTIATE_TEST_SUITE_P(Decoder, PhaseWrap,
                         testing::Values(Blur{"sharp", 0.2, 0, 0.7, 0}, Blur{"usual", 0.45, 0, 0.7, 0.004},
                                         Blur{"soft", 1.1, 0, 0.7, 0.004}, Blur{"skin", 0.5, 0.5, 0.4, 0.004},
                                         Blur{"dark", 0.45, 0, 0.12, 0.004},
                                         Blur{"dark_skin", 0.5, 0.5, 0.12, 0.003}),
                         [](const auto& tested) { return tested.param.name; });

TEST(DecoderPhase, CoordinatesRiseSteadilyAcrossEveryEdge) {
  const CaptureOptions options{.sequence = fast_sequence, .bits = 16};
  const Correspondence found = decode(plane_scene(options), options, unfitted());
  for (int y = 1; y < options.camera.height; ++y)
    for (int x = 0; x < options.camera.width; ++x)
      ASSERT_NEAR(found.rows->coordinate(x, y) - found.rows->coordinate(x, y - 1), 1 / 2.7, 0.05)
          << x << ' ' << y;
}

// A wrong response bends all steps alike; what harmonics that makes, the measurement of harmonics takes.
TEST(DecoderPhase, AWrongResponseCostsLittle) {
  const CaptureOptions options{.sequence = fast_sequence, .response = gamma_2_2, .bits = 16};
  const Scene scene = plane_scene(options, 30);
  const auto frames = capture(scene, options);
  for (const ToneResponse response : {linear, gamma_2_2, ToneResponse{}}) {
    DecodeOptions decoding = unfitted();
    decoding.response = response;
    const Correspondence found = decode(frames, sequence_of(options), decoding);
    const Comparison result = compare(*found.rows, Axis::row, scene, interior(options.camera));
    EXPECT_EQ(result.undecided, 0);
    EXPECT_LT(result.rms, 0.005);
  }
}

class PhaseSigma : public testing::TestWithParam<double> {};

TEST_P(PhaseSigma, AgreesWithTheActualError) {
  const CaptureOptions options{.sequence = fast_sequence, .read_noise = 0.003, .shot_noise = 2e-5};
  const Scene plane = plane_scene(options, 30);
  const Scene scene = [&](int x, int y) {
    Sight sight = plane(x, y);
    sight.albedo = GetParam();
    return sight;
  };
  const Correspondence found = decode(scene, options, unfitted());
  const Comparison result = compare(*found.rows, Axis::row, scene, interior(options.camera));
  EXPECT_LT(result.undecided, 0.005 * result.pixels);
  EXPECT_NEAR(std::log(result.rms / result.mean_sigma), 0, std::log(1.5));
}

INSTANTIATE_TEST_SUITE_P(Decoder, PhaseSigma, testing::Values(0.1, 0.15, 0.4, 0.8), [](const auto& tested) {
  return "albedo_" + std::to_string(std::lround(100 * tested.param));
});

// A sharp projector's stripes have harmonics that five steps take for the first.
class SharpStripes : public testing::TestWithParam<double> {};

TEST_P(SharpStripes, HarmonicsAreMeasuredAndTakenOff) {
  const CaptureOptions options{.sequence = fast_sequence, .bits = 16};
  const Scene scene = [plane = plane_scene(options, 30)](int x, int y) {
    Sight sight = plane(x, y);
    sight.blur_px = GetParam();
    return sight;
  };
  const Correspondence found = decode(scene, options, unfitted());
  const Comparison result = compare(*found.rows, Axis::row, scene, interior(options.camera));
  EXPECT_EQ(result.undecided, 0);
  // Without, 0.056 at a blur of 0.3, 0.013 at 0.45 and 0.004 at 0.55.
  EXPECT_LT(result.rms, GetParam() < 0.4 ? 0.02 : 0.0015);
}

INSTANTIATE_TEST_SUITE_P(Decoder, SharpStripes, testing::Values(0.3, 0.45, 0.55));

struct ScatteredLight {
  const char* name;
  double row;
  double spread_px;
};

void PrintTo(const ScatteredLight& tested, std::ostream* out) {
  *out << tested.name;
}

class PhaseShadow : public testing::TestWithParam<ScatteredLight> {};

// What little light comes from rows nearby still carries the coarse code, but not the fine stripes.
TEST_P(PhaseShadow, LitByOtherSurfacesOnlyIsUndecided) {
  const ScatteredLight& light = GetParam();
  const CaptureOptions options{.sequence = fast_sequence};
  const auto shaded = [](int x, int y) { return std::hypot(x - 128, y - 96) < 30; };
  const Scene scene = [&, plane = plane_scene(options, 30)](int x, int y) {
    Sight sight = plane(x, y);
    sight.scattered = 0.12;
    sight.scattered_row = light.row;
    sight.scattered_px = light.spread_px;
    sight.shadow = shaded(x, y);
    return sight;
  };
  const Correspondence found = decode(scene, options);
  EXPECT_EQ(compare(*found.rows, Axis::row, scene, shaded).pixels, 0);
  const Comparison outside = compare(*found.rows, Axis::row, scene, [&](int x, int y) {
    return interior(options.camera)(x, y) && !shaded(x, y);
  });
  EXPECT_EQ(outside.undecided, 0);
  EXPECT_LT(outside.rms, 0.01);
}

INSTANTIATE_TEST_SUITE_P(DecoderScattering, PhaseShadow,
                         testing::Values(ScatteredLight{"far", 400, 60}, ScatteredLight{"near", 300, 20},
                                         ScatteredLight{"close", 310, 3}),
                         [](const auto& tested) { return tested.param.name; });

TEST(DecoderPhase, WhereBlurTakesTheStripesTheGrayCodeStays) {
  const CaptureOptions options{.sequence = fast_sequence, .read_noise = 0.004, .shot_noise = 2e-5};
  const Scene scene = [plane = plane_scene(options, 30)](int x, int y) {
    Sight sight = plane(x, y);
    sight.blur_px = 2.5;
    return sight;
  };
  const Correspondence found = decode(scene, options);
  const Comparison result = compare(*found.rows, Axis::row, scene, interior(options.camera));
  EXPECT_EQ(result.undecided, 0);
  EXPECT_LT(result.rms, 0.03);
}

}  // namespace
}  // namespace bodyscan
