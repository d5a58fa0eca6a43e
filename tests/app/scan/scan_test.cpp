#include "app/scan/scan.hpp"

#include "tests/app/scan/measured_plane.hpp"
#include "tests/app/scan/world.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_files.hpp"

#include <atomic>
#include <iterator>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace bodyscan {
namespace {

namespace fs = std::filesystem;

std::ptrdiff_t entries(const char* folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

class Scan : public testing::Test {
 protected:
  TemporaryFolder folder_;
  World world_{folder_.path()};
};

TEST_F(Scan, MakesAModel) {
  const Expected<ScanReport> report = world_.scan();
  ASSERT_TRUE(report) << report.error().message;
  const MeasuredPlane plane = measured_plane(world_.options.model.path);
  EXPECT_GT(plane.points, 40'000U);
  EXPECT_LT(plane.rms_mm, 0.5);
  EXPECT_EQ(report->shooting.shots, world_patterns);
  EXPECT_EQ(world_.camera.shots(), world_patterns);
  EXPECT_TRUE(report->refused.empty());
  EXPECT_TRUE(report->shooting.troubles.empty());
  EXPECT_EQ(report->shot_again_for_motion, 0);
  EXPECT_LT(report->motion_mm, 0.5);
  EXPECT_GT(report->light_s, 0);
  EXPECT_FALSE(world_.projector.lit());
  EXPECT_FALSE(world_.projector.is_open());
  EXPECT_FALSE(world_.camera.is_open());
}

TEST_F(Scan, ReportsItsFigures) {
  ASSERT_TRUE(world_.scan());
  const auto json = nlohmann::json::parse(read_text(*world_.options.model.report));
  EXPECT_GT(json.at("points"), 40'000);
  const auto& scan = json.at("scan");
  EXPECT_EQ(scan.at("camera").at("model"), "Fake");
  EXPECT_EQ(scan.at("camera").at("serial"), "0815");
  EXPECT_EQ(scan.at("shots"), world_patterns);
  for (const char* key :
       {"exposure_us", "iso", "aperture", "refused", "troubles", "motion_px", "motion_mm", "motion_at_px",
        "shot_again_for_motion", "light_s", "after_last_shot_ms", "times_ms"})
    EXPECT_TRUE(scan.contains(key)) << key;
  for (const char* key : {"show", "settle", "exposure", "camera", "fetch", "recovery", "total"})
    EXPECT_TRUE(scan.at("times_ms").contains(key)) << key;
}

TEST_F(Scan, KeepsThePhotographsWhereThatIsAskedFor) {
  world_.options.photographs = folder_ / "photographs";
  ASSERT_TRUE(world_.scan());
  EXPECT_EQ(entries((folder_ / "photographs").c_str()), world_patterns);  // capture.json for the last white
}

TEST_F(Scan, AnInterruptInMidScanDarkensAndLeavesNothing) {
  std::atomic<bool> stopped = false;
  world_.projector.on_flip = [&](int flip) { stopped = flip >= 6; };
  world_.stop = [&]() -> Expected<void> {
    if (stopped) return tl::unexpected(Error{ErrorKind::usage, "interrupted"});
    return {};
  };
  world_.options.rig.projector.settle_ms = 30;  // longer than the guard looks away
  const Expected<ScanReport> report = world_.scan();
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().message, "interrupted");
  EXPECT_LT(world_.camera.shots(), world_patterns);
  EXPECT_FALSE(world_.projector.lit());
  EXPECT_FALSE(world_.camera.is_open());
  EXPECT_TRUE(fs::is_empty(folder_ / "results"));
}

TEST_F(Scan, TooMuchLightIsAQualityErrorWithAReportAndNoModel) {
  world_.options.rig.scan.max_light_s = 0.1;
  world_.options.rig.projector.settle_ms = 50;
  world_.options.photographs = folder_ / "photographs";
  const Expected<ScanReport> report = world_.scan();
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().kind, ErrorKind::quality) << report.error().message;
  EXPECT_FALSE(world_.projector.lit());
  EXPECT_FALSE(fs::exists(world_.options.model.path));
  EXPECT_FALSE(fs::exists(folder_ / "photographs"));  // half a capture is none
  const auto json = nlohmann::json::parse(read_text(*world_.options.model.report));
  EXPECT_GT(json.at("scan").at("shots"), 0);
}

TEST_F(Scan, PicturesOfAnotherSizeThanTheCalibrationsAreADeviceError) {
  world_.camera.picture = Size{160, 120};
  const Expected<ScanReport> report = world_.scan();
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().kind, ErrorKind::device);
  EXPECT_NE(report.error().message.find("160 x 120"), std::string::npos) << report.error().message;
  EXPECT_FALSE(world_.projector.lit());
  EXPECT_TRUE(fs::is_empty(folder_ / "results"));
}

TEST_F(Scan, FiftyScansLeaveNoDescriptorAndNoThread) {
  ASSERT_TRUE(world_.scan());  // with it the thread pool, which stays
  const std::ptrdiff_t descriptors = entries("/proc/self/fd");
  const std::ptrdiff_t threads = entries("/proc/self/task");
  for (int i = 0; i < 50; ++i) {
    const Expected<ScanReport> report = world_.scan();
    ASSERT_TRUE(report) << i << ": " << report.error().message;
  }
  EXPECT_EQ(entries("/proc/self/fd"), descriptors);
  EXPECT_EQ(entries("/proc/self/task"), threads);
}

}  // namespace
}  // namespace bodyscan
