#include "pipeline/decode/decoder.hpp"
#include "tests/pipeline/decode/synthetic_capture.hpp"

#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

const CaptureOptions small{.camera = {48, 40}, .projector = {32, 16}};

std::vector<Frame> small_capture() {
  return capture(plane_scene(small, 0, 4), small);
}

// The error of the first call that fails; an empty message if none does.
Error first_error(const std::vector<Frame>& frames, const PatternSequence& sequence = sequence_of(small)) {
  auto decoder = Decoder::create(sequence);
  if (!decoder) return decoder.error();
  for (const Frame& frame : frames)
    if (auto taken = decoder->consume(frame); !taken) return taken.error();
  const auto found = decoder->finish();
  return found ? Error{} : found.error();
}

void expect_input_error(const Error& error, const std::string& part) {
  EXPECT_EQ(error.kind, ErrorKind::input);
  EXPECT_NE(error.message.find(part), std::string::npos) << error.message;
}

TEST(DecoderErrors, AWholeCaptureHasNone) {
  EXPECT_EQ(first_error(small_capture()).message, "");
}

TEST(DecoderErrors, AFrameOutOfOrderNamesBothPatterns) {
  auto frames = small_capture();
  std::swap(frames[4].pattern, frames[5].pattern);
  const Error error = first_error(frames);
  expect_input_error(error, "expected the frame of pattern gray row bit 2,");
  expect_input_error(error, "got gray row bit 2 inverted");
}

TEST(DecoderErrors, TheFirstFrameMustBeWhite) {
  auto frames = small_capture();
  std::swap(frames[0].pattern, frames[1].pattern);
  expect_input_error(first_error(frames), "expected the frame of pattern white, got black");
}

TEST(DecoderErrors, AFrameOfAnotherSize) {
  for (const std::size_t which : {1, 2, 3, 9}) {
    auto frames = small_capture();
    frames[which].luma = GrayImage8({48, 41}, 0);
    expect_input_error(first_error(frames), describe(frames[which].pattern) + " differs");
  }
}

TEST(DecoderErrors, AFrameOfAnotherDepth) {
  auto frames = small_capture();
  frames[6].luma = GrayImage16(small.camera, 0);
  expect_input_error(first_error(frames), "gray row bit 1 differs");
}

TEST(DecoderErrors, TooFewFramesNameTheMissingOne) {
  auto frames = small_capture();
  frames.pop_back();
  expect_input_error(first_error(frames), "gray row bit 0 inverted is missing");
  expect_input_error(first_error({}), "white is missing");
}

TEST(DecoderErrors, PhaseStepsMustAllComeInOrder) {
  CaptureOptions options = small;
  options.sequence = fast_sequence;
  const auto captured = [&] { return capture(plane_scene(options, 0, 4), options); };
  const auto frames = captured();
  const PatternSequence sequence = sequence_of(options);
  EXPECT_EQ(first_error(frames, sequence).message, "");

  auto missing = captured();
  missing.erase(missing.begin() + 4);
  expect_input_error(first_error(missing, sequence),
                     "expected the frame of pattern phase row step 2 of 5 (period 5), got phase row step 3");
  auto twice = captured();
  twice[4].pattern = twice[3].pattern;
  expect_input_error(first_error(twice, sequence), "phase row step 2 of 5 (period 5), got phase row step 1");

  PatternSequence without = sequence;
  without.patterns.erase(without.patterns.begin() + 4);
  EXPECT_EQ(first_error(frames, without).kind, ErrorKind::usage);
  PatternSequence other_period = sequence;
  other_period.patterns[4].period_px = 10;
  EXPECT_EQ(first_error(frames, other_period).kind, ErrorKind::usage);
  PatternSequence too_coarse = sequence;
  too_coarse.patterns.pop_back();
  EXPECT_EQ(first_error(frames, too_coarse).kind, ErrorKind::usage);
  PatternSequence no_bits = sequence;
  no_bits.patterns.resize(7);
  EXPECT_EQ(first_error(frames, no_bits).kind, ErrorKind::usage);
}

TEST(DecoderErrors, TooManyFrames) {
  auto frames = small_capture();
  frames.push_back({frames.back().pattern, GrayImage8(small.camera, 0)});
  expect_input_error(first_error(frames), "after the sequence's last");
}

TEST(DecoderErrors, WhiteDarkerThanBlack) {
  auto frames = small_capture();
  frames[0].luma = GrayImage8(small.camera, 10);
  expect_input_error(first_error(frames), "white frame is darker");
}

TEST(DecoderErrors, NothingIsLit) {
  auto frames = small_capture();
  for (Frame& frame : frames) frame.luma = GrayImage8(small.camera, 30);
  expect_input_error(first_error(frames), "nothing is lit");
}

TEST(DecoderErrors, AFailedFrameDoesNotCount) {
  const auto frames = small_capture();
  auto decoder = Decoder::create(sequence_of(small));
  ASSERT_TRUE(decoder.has_value());
  EXPECT_FALSE(decoder->consume(frames[1]).has_value());
  for (const Frame& frame : frames)
    EXPECT_TRUE(decoder->consume(frame).has_value()) << describe(frame.pattern);
  EXPECT_TRUE(decoder->finish().has_value());
}

TEST(DecoderErrors, SequencesInAnyOtherOrder) {
  const PatternSequence good = sequence_of({.sequence = {true, true, true}, .projector = {32, 16}});
  const auto refused = [&](const auto& change) {
    PatternSequence sequence = good;
    change(sequence.patterns);
    const auto decoder = Decoder::create(sequence);
    return !decoder && decoder.error().kind == ErrorKind::usage && !decoder.error().message.empty();
  };
  ASSERT_TRUE(Decoder::create(good).has_value());
  EXPECT_TRUE(refused([](auto& patterns) { std::swap(patterns[0], patterns[1]); }));
  EXPECT_TRUE(refused([](auto& patterns) { std::swap(patterns[2], patterns[3]); }));
  EXPECT_TRUE(refused([](auto& patterns) { std::swap(patterns[2], patterns[4]); }));
  EXPECT_TRUE(refused([](auto& patterns) { patterns.erase(patterns.begin() + 5); }));
  EXPECT_TRUE(refused([](auto& patterns) { patterns.pop_back(); }));
  EXPECT_TRUE(refused([](auto& patterns) { patterns.push_back(patterns.back()); }));
  EXPECT_TRUE(refused([](auto& patterns) { patterns.erase(patterns.begin()); }));
  EXPECT_TRUE(refused([](auto& patterns) { patterns.resize(2); }));
  EXPECT_TRUE(refused([](auto& patterns) { patterns.clear(); }));
  EXPECT_TRUE(refused([](auto& patterns) { patterns[3].bit = 9; }));
}

TEST(DecoderErrors, AProjectorOfNoSize) {
  PatternSequence sequence = sequence_of(small);
  sequence.projector = {0, 16};
  EXPECT_FALSE(Decoder::create(sequence).has_value());
}

TEST(DecoderErrors, TheSmallestProjectorsDecodeNothingWrong) {
  for (const int height : {3, 4, 5, 8}) {
    CaptureOptions options = small;
    options.projector.height = height;
    const Scene scene = plane_scene(options, 0, 12);
    const Correspondence found = decode(scene, options);
    const Comparison lit = compare(*found.rows, Axis::row, scene, [&](int x, int y) {
      return scene(x, y).row > 1 && scene(x, y).row < height - 2;
    });
    EXPECT_EQ(lit.undecided, 0) << height;
    EXPECT_LT(lit.worst, 0.2) << height;
  }
}

TEST(DecoderErrors, TwoRowsAreTooFewToPlaceAnything) {
  CaptureOptions options = small;
  options.projector.height = 2;
  const Correspondence found = decode(plane_scene(options, 0, 30), options);
  EXPECT_EQ(found.pixels_decoded, 0U);
  EXPECT_GT(found.pixels_lit, 0U);
}

TEST(DecodeOptionsCheck, NamesTheOptionThatIsOutOfRange) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  const auto refused = [](const char* name, const auto& change) {
    DecodeOptions options;
    change(options);
    const auto decoder = Decoder::create(sequence_of(small), options);
    ASSERT_FALSE(decoder.has_value()) << name;
    EXPECT_EQ(decoder.error().kind, ErrorKind::usage);
    EXPECT_NE(decoder.error().message.find(name), std::string::npos) << decoder.error().message;
  };
  for (const float value : {0.0F, 256.0F, nan})
    refused("min_contrast", [=](DecodeOptions& options) { options.min_contrast = value; });
  for (const float value : {-0.1F, 1.0F, nan})
    refused("min_direct_share", [=](DecodeOptions& options) { options.min_direct_share = value; });
  for (const float value : {-1.0F, nan})
    refused("min_signal_to_noise", [=](DecodeOptions& options) { options.min_signal_to_noise = value; });
  for (const int value : {-1, 3})
    refused("max_dropped_bits", [=](DecodeOptions& options) { options.max_dropped_bits = value; });
  for (const double value : {0.0, 0.05, 11.0, static_cast<double>(nan)})
    refused("gamma", [=](DecodeOptions& options) { options.response = {ToneResponse::Kind::gamma, value}; });
  for (const float value : {-1.0F, 21.0F, nan})
    refused("half width", [=](DecodeOptions& options) { options.fit.half_width_px = value; });
  refused("half width", [](DecodeOptions& options) { options.fit.max_half_width_px = 21; });
  for (const float value : {-0.1F, nan})
    refused("enough_sigma_px", [=](DecodeOptions& options) { options.fit.enough_sigma_px = value; });
}

}  // namespace
}  // namespace bodyscan
