#include "hal/replay/calibration_session.hpp"

#include "pipeline/image/codec.hpp"
#include "tests/pipeline/image/image_fixtures.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_files.hpp"

#include <fstream>
#include <string>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

namespace fs = std::filesystem;

constexpr Size picture{8, 4};

// Two pairs around a capture; the printed picture of pose p has the value 10 p, the projected one 10 p + 1.
class CalibrationSessionTest : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(folder_ / "session.json") << R"({
      "format": "bodyscan-calibration-session", "version": 1,
      "board": {"columns": 9, "rows": 7, "square_mm": 25}, "projector": {"width": 64, "height": 32},
      "projected_board": {"columns": 3, "rows": 3, "first_corner_px": [10, 5], "square_px": 8},
      "poses": [{"printed": "p0", "projected": "q0"}, {"capture": "c1"}, {"printed": "p2", "projected": "q2"}]
    })";
    write_picture("p0", 0);
    write_picture("q0", 1);
    write_picture("p2", 20);
    write_picture("q2", 21);
    write_capture({.rows = true, .columns = true}, {64, 32}, picture);
  }

  void write_picture(const std::string& name, std::uint8_t value, Size size = picture) const {
    write_bytes(folder_ / name, encode_png(GrayImage8(size, value)).value());
  }
  void write_capture(const SequenceOptions& options, Size projector, Size size) const {
    fs::create_directories(folder_ / "c1");
    CaptureManifest manifest;
    manifest.projector = projector;
    const PatternSequence sequence = make_sequence(projector, options).value();
    for (const Pattern& pattern : sequence.patterns) {
      const std::string name = std::to_string(manifest.frames.size()) + ".png";
      manifest.frames.push_back({name, pattern, {}});
      write_picture("c1/" + name, 7, size);
    }
    ASSERT_TRUE(write_manifest(manifest, folder_ / "c1" / "capture.json"));
  }

  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] std::string open_message() const {
    const auto session = CalibrationSession::open(folder_);
    return session ? "opened" : session.error().message;
  }

  TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path();
};

TEST_F(CalibrationSessionTest, OffersPicturesAndCaptures) {
  const auto session = CalibrationSession::open(folder_);
  ASSERT_TRUE(session) << session.error().message;
  EXPECT_EQ(session->size(), picture);
  EXPECT_EQ(session->pose_count(), 3);
  EXPECT_EQ(session->manifest().poses[2].name, "pose 2");
  for (const int pose : {0, 2}) {
    EXPECT_EQ(std::get<GrayImage8>(session->load_printed(pose).value())(7, 3), 10 * pose);
    EXPECT_EQ(std::get<GrayImage8>(session->load_projected(pose).value())(7, 3), 10 * pose + 1);
  }
  EXPECT_EQ(session->capture(1).frame_count(), 2 + 2 * (6 + 5));
  EXPECT_EQ(std::get<GrayImage8>(session->capture(1).load(0)->luma)(0, 0), 7);
}

TEST_F(CalibrationSessionTest, PicturesMayBeJpegsOrHaveSixteenBits) {
  write_bytes(folder_ / "p0", encode_png(GrayImage16(picture, 54321)).value());
  write_bytes(folder_ / "q0", make_gray_jpeg(GrayImage8(picture, 99)));
  const auto session = CalibrationSession::open(folder_);
  ASSERT_TRUE(session) << session.error().message;
  EXPECT_EQ(std::get<GrayImage16>(session->load_printed(0).value())(0, 0), 54321);
  EXPECT_EQ(std::get<GrayImage8>(session->load_projected(0).value())(0, 0), 99);
}

TEST_F(CalibrationSessionTest, NamesWhatIsMissing) {
  fs::remove(folder_ / "q2");
  EXPECT_EQ(open_message(), "pose 2: " + path("q2") + ": No such file or directory");
  fs::remove(folder_ / "c1" / "5.png");
  EXPECT_EQ(open_message(), "pose 1: " + path("c1/5.png") + ": No such file or directory");
  fs::remove_all(folder_ / "c1");
  EXPECT_EQ(open_message(), "pose 1: " + path("c1/capture.json") + ": No such file or directory");
  fs::remove(folder_ / "p0");
  fs::create_directories(folder_ / "p0");
  EXPECT_EQ(open_message().substr(0, 9 + path("p0").size()), "pose 0: " + path("p0") + ":");
  fs::remove(folder_ / "session.json");
  EXPECT_EQ(open_message(), path("session.json") + ": No such file or directory");
}

TEST_F(CalibrationSessionTest, NamesThePlaceInTheManifest) {
  std::ofstream(folder_ / "session.json") << R"({"format": "bodyscan-calibration-session", "version": 1})";
  EXPECT_EQ(open_message(), path("session.json") + ": board: missing");
}

TEST_F(CalibrationSessionTest, NamesAPictureOfAnotherSize) {
  write_picture("q2", 0, {4, 8});
  EXPECT_EQ(open_message(), "pose 2: " + path("q2") + ": 4 x 8 pixels, while " + path("p0") + " has 8 x 4");
  write_capture({.rows = true, .columns = true}, {64, 32}, {8, 5});
  EXPECT_EQ(open_message(), "pose 1: " + path("c1") + ": 8 x 5 pixels, while " + path("p0") + " has 8 x 4");
}

TEST_F(CalibrationSessionTest, NamesACaptureWithoutBothAxes) {
  write_capture({.rows = true, .columns = false}, {64, 32}, picture);
  EXPECT_EQ(open_message(), "pose 1: " + path("c1/capture.json") +
                                ": has no column patterns; a calibration needs rows and columns");
  write_capture({.rows = false, .columns = true}, {64, 32}, picture);
  EXPECT_EQ(open_message(), "pose 1: " + path("c1/capture.json") +
                                ": has no row patterns; a calibration needs rows and columns");
}

TEST_F(CalibrationSessionTest, NamesACaptureOfAnotherProjector) {
  write_capture({.rows = true, .columns = true}, {32, 64}, picture);
  EXPECT_EQ(open_message(),
            "pose 1: " + path("c1/capture.json") + ": projector: 32 x 64, while the session's has 64 x 32");
}

TEST_F(CalibrationSessionTest, NamesABombAndANonImage) {
  write_bytes(folder_ / "q0", png_claiming(encode_png(GrayImage8(picture, 0)).value(), 16000, 16000));
  EXPECT_EQ(open_message(),
            "pose 0: " + path("q0") + ": 16000 x 16000 pixels: over the limit of 64000000 pixels");
  write_bytes(folder_ / "p0", std::as_bytes(std::span("hello")));
  EXPECT_EQ(open_message(), "pose 0: " + path("p0") + ": not a JPEG or PNG file");
}

TEST_F(CalibrationSessionTest, LoadNoticesWhatChangedSinceOpen) {
  const auto session = CalibrationSession::open(folder_);
  ASSERT_TRUE(session) << session.error().message;
  write_picture("p0", 0, {9, 4});
  EXPECT_EQ(session->load_printed(0).error().message,
            path("p0") + ": 9 x 4 pixels, while " + path("p0") + " has 8 x 4");
  fs::resize_file(folder_ / "q2", 40);
  EXPECT_EQ(session->load_projected(2).error().message, path("q2") + ": damaged PNG: the file ends early");
}

}  // namespace
}  // namespace bodyscan
