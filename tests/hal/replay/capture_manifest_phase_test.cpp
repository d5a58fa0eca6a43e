#include "hal/replay/capture_manifest.hpp"
#include "pipeline/base/read_file.hpp"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

// 16 rows: four bits, of which the two coarsest stay beside stripes of three rows; in no order.
constexpr std::string_view good = R"({
  "format": "bodyscan-capture", "version": 1,
  "projector": {"width": 1024, "height": 16},
  "frames": [
    {"file": "h.png", "pattern": "gray", "axis": "row", "bit": 1},
    {"file": "d.png", "pattern": "phase", "axis": "row", "period_px": 3, "step": 1, "steps": 3},
    {"file": "f.png", "pattern": "gray", "axis": "row", "bit": 3},
    {"file": "e.png", "pattern": "phase", "axis": "row", "period_px": 3, "step": 2, "steps": 3},
    {"file": "g.png", "pattern": "gray", "axis": "row", "bit": 2, "inverted": false},
    {"file": "b.png", "pattern": "black"},
    {"file": "c.png", "pattern": "phase", "axis": "row", "period_px": 3, "step": 0, "steps": 3},
    {"file": "a.png", "pattern": "white"}
  ]
})";

std::string replaced(std::string_view from, std::string_view to) {
  std::string text(good);
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string message(const std::string& text) {
  const auto manifest = parse_manifest(text, "capture.json");
  return manifest ? "accepted" : manifest.error().message;
}

TEST(ParsePhaseManifest, PutsAnAxissStepsBeforeItsBits) {
  const auto manifest = parse_manifest(good, "capture.json");
  ASSERT_TRUE(manifest) << manifest.error().message;
  std::string names;
  PatternSequence sequence{manifest->projector, {}};
  for (const ManifestFrame& frame : manifest->frames) {
    names += frame.file[0];
    sequence.patterns.push_back(frame.pattern);
  }
  EXPECT_EQ(names, "abcdefgh");
  const PhaseCode code{.period_px = 3, .steps = 3, .finest_bit = 1};
  EXPECT_EQ(sequence.patterns, make_sequence({1024, 16}, {.phase = code}).value().patterns);
}

TEST(ParsePhaseManifest, MayHoldMoreBitsThanThePeriodNeeds) {
  EXPECT_EQ(
      message(replaced("    {\"file\": \"a.png\"",
                       "    {\"file\": \"i.png\", \"pattern\": \"gray\", \"axis\": \"row\", \"bit\": 0},\n"
                       "    {\"file\": \"a.png\"")),
      "accepted");
}

struct Damage {
  std::string_view from;
  std::string_view to;
  std::string_view message;  // behind "capture.json: "
};

constexpr Damage damages[] = {
    {R"("axis": "row", "period_px": 3, "step": 1)", R"("period_px": 3, "step": 1)",
     "frames[1].axis: missing"},
    {R"("axis": "row", "period_px": 3, "step": 1)", R"("axis": 3, "period_px": 3, "step": 1)",
     "frames[1].axis: not a string"},
    {R"("period_px": 3, "step": 1)", R"("step": 1)", "frames[1].period_px: missing"},
    {R"("period_px": 3, "step": 1)", R"("period_px": 3.5, "step": 1)", "frames[1].period_px: not an integer"},
    {R"("period_px": 3, "step": 1)", R"("period_px": 2, "step": 1)",
     "frames[1].period_px: 2 does not lie in 3 to 64"},
    {R"("period_px": 3, "step": 1)", R"("period_px": 65, "step": 1)",
     "frames[1].period_px: 65 does not lie in 3 to 64"},
    {R"("period_px": 3, "step": 1)", R"("period_px": 4, "step": 1)",
     "frames[1].steps: 3 does not divide the period of 4"},
    {R"("step": 1, "steps": 3)", R"("step": 1)", "frames[1].steps: missing"},
    {R"("step": 1, "steps": 3)", R"("step": 1, "steps": 2)", "frames[1].steps: 2 does not lie in 3 to 64"},
    {R"("step": 1, "steps": 3)", R"("step": 1, "steps": "three")", "frames[1].steps: not an integer"},
    {R"("step": 1, "steps": 3)", R"("steps": 3)", "frames[1].step: missing"},
    {R"("step": 1, "steps": 3)", R"("step": 3, "steps": 3)", "frames[1].step: 3 does not lie in 0 to 2"},
    {R"("step": 1, "steps": 3)", R"("step": -1, "steps": 3)", "frames[1].step: -1 does not lie in 0 to 2"},
    {R"("step": 1, "steps": 3)", R"("step": 2, "steps": 3)",
     "frames[3]: phase row step 2 of 3 (period 3) again, after frames[1]"},
    {R"("period_px": 3, "step": 2, "steps": 3)", R"("period_px": 6, "step": 2, "steps": 3)",
     "frames: phase row step 2 of 3 (period 6) does not go with phase row step 0 of 3 (period 3)"},
    {R"("pattern": "phase", "axis": "row", "period_px": 3, "step": 1, "steps": 3)",
     R"("pattern": "gray", "axis": "row", "bit": 0)", "frames: phase row step 1 of 3 (period 3) is missing"},
    {R"("bit": 2)", R"("bit": 0)", "frames: gray row bit 2 is missing"},
    {R"("bit": 1)", R"("bit": 0)", "frames: gray row bit 1 is missing"},
    {R"("bit": 2, "inverted": false)", R"("bit": 2, "inverted": true)",
     "frames: gray row bit 2 inverted beside phase steps, which need no inverses"},
    {R"("axis": "row", "bit": 3)", R"("axis": "column", "bit": 3)", "frames: gray row bit 3 is missing"},
};

TEST(ParsePhaseManifest, NamesEveryDamage) {
  for (const Damage& damage : damages)
    EXPECT_EQ(message(replaced(damage.from, damage.to)), "capture.json: " + std::string(damage.message))
        << damage.to;
}

// The finest bit that stays must have cells smaller than a period.
TEST(ParsePhaseManifest, MissesTheBitThatThePeriodNeeds) {
  const std::string without = replaced(R"(    {"file": "h.png", "pattern": "gray", "axis": "row", "bit": 1},
)",
                                       "");
  EXPECT_EQ(message(without), "capture.json: frames: gray row bit 1 is missing");
}

TEST(WritePhaseManifest, ReadsBackEqual) {
  const auto path = std::filesystem::path(testing::TempDir()) / "bodyscan_phase_manifest.json";
  const CaptureManifest manifest = parse_manifest(good, "").value();
  ASSERT_TRUE(write_manifest(manifest, path));
  const auto read = parse_manifest(as_text(read_file(path, max_manifest_bytes).value()), "written");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->frames.size(), manifest.frames.size());
  for (std::size_t i = 0; i < read->frames.size(); ++i)
    EXPECT_EQ(read->frames[i].pattern, manifest.frames[i].pattern);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace bodyscan
