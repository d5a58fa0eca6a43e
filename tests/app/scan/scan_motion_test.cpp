#include "app/scan/scan.hpp"
#include "tests/app/scan/measured_plane.hpp"
#include "tests/app/scan/world.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_files.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace bodyscan {
namespace {

class ScanOfAMovingSubject : public testing::Test {
 protected:
  TemporaryFolder folder_;
  World world_{folder_.path()};
};

// It moves from where it began to where the plane is expected.
TEST_F(ScanOfAMovingSubject, OnlyThePatternsBeforeTheMotionAreShotAgain) {
  world_.camera.moved_mm = [](int shot) { return shot < 6 ? 6.0 : 0.0; };
  const Expected<ScanReport> report = world_.scan();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->shot_again_for_motion, 7);  // six and the white at the end
  EXPECT_EQ(report->shooting.shots, world_patterns + 7);
  EXPECT_LT(report->motion_mm, 1);
  const MeasuredPlane plane = measured_plane(world_.options.model.path);
  EXPECT_GT(plane.points, 40'000U);
  EXPECT_LT(plane.rms_mm, 0.5);
  EXPECT_LT(std::abs(plane.mean_mm), 0.5);
}

TEST_F(ScanOfAMovingSubject, NothingIsShotAgainWithinTheLimit) {
  world_.options.rig.scan.max_motion_mm = 8;
  world_.camera.moved_mm = [](int shot) { return shot < 6 ? 6.0 : 0.0; };
  const Expected<ScanReport> report = world_.scan();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->shot_again_for_motion, 0);
  EXPECT_NEAR(report->motion_mm, 6, 1);
}

TEST_F(ScanOfAMovingSubject, MovingAllTheTimeIsAQualityErrorWithAReportAndNoModel) {
  world_.camera.moved_mm = [](int shot) { return 0.4 * shot; };
  const Expected<ScanReport> report = world_.scan();
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().kind, ErrorKind::quality) << report.error().message;
  EXPECT_NE(report.error().message.find("moved by"), std::string::npos) << report.error().message;
  EXPECT_FALSE(world_.projector.lit());
  EXPECT_FALSE(std::filesystem::exists(world_.options.model.path));
  const auto json = nlohmann::json::parse(read_text(*world_.options.model.report));
  EXPECT_GT(json.at("scan").at("motion_mm"), 1);
  EXPECT_GT(json.at("scan").at("shot_again_for_motion"), 0);
}

}  // namespace
}  // namespace bodyscan
