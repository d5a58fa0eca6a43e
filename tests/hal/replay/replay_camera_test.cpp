#include "hal/replay/replay_camera.hpp"

#include "hal/clock.hpp"
#include "tests/hal/replay/capture_fixture.hpp"

#include <algorithm>
#include <limits>

namespace bodyscan {
namespace {

class ReplayCameraTest : public CaptureFixture {
 protected:
  [[nodiscard]] ReplayCamera camera() const { return ReplayCamera(CaptureFolder::open(folder_).value()); }

  static Expected<Photograph> shoot(ReplayCamera& camera) {
    return camera.expose().and_then([&] { return camera.fetch(); });
  }

  // The brightness that says which frame it is.
  static int shown(const Expected<Photograph>& photograph) {
    if (!photograph) return -1;
    const auto luma = decode_luma(photograph->file);
    return luma ? std::get<GrayImage8>(*luma)(7, 3) : -1;
  }
};

template <class Value>
std::string message(const Expected<Value>& answer) {
  if (answer) return "done";
  EXPECT_EQ(answer.error().kind, ErrorKind::device);
  return answer.error().message;
}

TEST_F(ReplayCameraTest, DeliversTheFramesInDecodeOrderAndThenAgain) {
  std::reverse(manifest_.frames.begin(), manifest_.frames.end());
  ASSERT_TRUE(write_manifest(manifest_, folder_ / "capture.json"));
  ReplayCamera camera = this->camera();
  ASSERT_TRUE(camera.open());
  for (int shot = 0; shot < 2 * 14 + 1; ++shot) EXPECT_EQ(shown(shoot(camera)), value(shot % 14)) << shot;
}

TEST_F(ReplayCameraTest, OpenStartsFromTheBeginning) {
  ReplayCamera camera = this->camera();
  ASSERT_TRUE(camera.open());
  EXPECT_EQ(shown(shoot(camera)), value(0));
  EXPECT_EQ(shown(shoot(camera)), value(1));
  camera.close();
  ASSERT_TRUE(camera.open());
  EXPECT_EQ(shown(shoot(camera)), value(0));
}

TEST_F(ReplayCameraTest, PreviewIsWhiteAndTakesNoFrame) {
  ReplayCamera camera = this->camera();
  ASSERT_TRUE(camera.open());
  EXPECT_EQ(shown(shoot(camera)), value(0));
  EXPECT_EQ(shown(camera.preview()), value(0));
  EXPECT_EQ(shown(shoot(camera)), value(1));
}

TEST_F(ReplayCameraTest, AnswersWhatTheFolderSaysOfItsPhotographs) {
  const CameraSettings wanted{20'000, 800, 4, {100, 100}};
  ReplayCamera unknown = camera();
  EXPECT_EQ(unknown.open().value().model, "replayed camera");
  EXPECT_EQ(unknown.configure(wanted).value(), (CameraSettings{20'000, 800, 4, frame_size}));
  manifest_.camera = "D5000";
  manifest_.exposure_us = 16666.7;
  manifest_.iso = 400;
  manifest_.aperture = 5.6;
  ASSERT_TRUE(write_manifest(manifest_, folder_ / "capture.json"));
  ReplayCamera known = camera();
  EXPECT_EQ(known.open().value().model, "D5000");
  EXPECT_EQ(known.configure(wanted).value(), (CameraSettings{16667, 400, 5.6, frame_size}));
  manifest_.exposure_us = 1e30;
  ASSERT_TRUE(write_manifest(manifest_, folder_ / "capture.json"));
  ReplayCamera endless = camera();
  ASSERT_TRUE(endless.open());
  EXPECT_EQ(endless.configure(wanted).value().exposure_us, std::numeric_limits<int>::max());
}

TEST_F(ReplayCameraTest, TheTimeIsTheShots) {
  ReplayCamera camera = this->camera();
  ASSERT_TRUE(camera.open());
  const std::int64_t before = monotonic_us();
  const std::int64_t time = shoot(camera).value().exposure_end_us;
  EXPECT_LE(before, time);
  EXPECT_LE(time, monotonic_us());
}

TEST_F(ReplayCameraTest, ACallInTheWrongStateNamesBoth) {
  ReplayCamera camera = this->camera();
  const std::string closed = "replayed camera: is closed, not ";
  EXPECT_EQ(message(camera.configure({})), closed + "ready");
  EXPECT_EQ(message(camera.expose()), closed + "ready");
  EXPECT_EQ(message(camera.fetch()), closed + "exposed");
  EXPECT_EQ(message(camera.preview()), closed + "ready");
  ASSERT_TRUE(camera.open());
  EXPECT_EQ(message(camera.fetch()), "replayed camera: is ready, not exposed");
  ASSERT_TRUE(camera.expose());
  const std::string exposed = "replayed camera: is exposed, not ready";
  EXPECT_EQ(message(camera.configure({})), exposed);
  EXPECT_EQ(message(camera.expose()), exposed);
  EXPECT_EQ(message(camera.preview()), exposed);
  EXPECT_EQ(shown(camera.fetch()), value(0));
  camera.close();
  camera.close();
  EXPECT_EQ(message(camera.expose()), closed + "ready");
}

TEST_F(ReplayCameraTest, AFileThatIsGoneIsADeviceErrorAndTheNextOneComes) {
  ReplayCamera camera = this->camera();
  ASSERT_TRUE(camera.open());
  std::filesystem::remove(folder_ / "frame_1.png");
  EXPECT_EQ(shown(shoot(camera)), value(0));
  EXPECT_EQ(message(shoot(camera)),
            "replayed camera: " + path("frame_1.png") + ": No such file or directory");
  EXPECT_EQ(shown(shoot(camera)), value(2));
}

}  // namespace
}  // namespace bodyscan
