#include "app/scan/scan.hpp"
#include "tests/app/scan/measured_plane.hpp"
#include "tests/app/scan/world.hpp"
#include "tests/support/temporary_folder.hpp"

#include <string>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

namespace fs = std::filesystem;

class ScanWithFaults : public testing::Test {
 protected:
  // The model is as good as one of a scan without faults.
  static ScanReport scan_well(World& world) {
    Expected<ScanReport> report = world.scan();
    EXPECT_TRUE(report) << report.error().message;
    if (report) {
      const MeasuredPlane plane = measured_plane(world.options.model.path);
      static const MeasuredPlane clean = clean_plane();
      EXPECT_NEAR(static_cast<double>(plane.points), static_cast<double>(clean.points),
                  0.01 * static_cast<double>(clean.points));
      EXPECT_NEAR(plane.rms_mm, clean.rms_mm, 0.1);
      EXPECT_NEAR(plane.mean_mm, clean.mean_mm, 0.1);
    }
    EXPECT_FALSE(world.projector.lit());
    EXPECT_FALSE(world.camera.is_open());
    return report ? *report : ScanReport{};
  }

  // A device error with these words, and nothing is left behind.
  void scan_in_vain(const std::string& words) {
    const Expected<ScanReport> report = world_.scan();
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().kind, ErrorKind::device);
    EXPECT_NE(report.error().message.find(words), std::string::npos) << report.error().message;
    EXPECT_FALSE(world_.projector.lit());
    EXPECT_FALSE(world_.projector.is_open());
    EXPECT_FALSE(world_.camera.is_open());
    EXPECT_TRUE(fs::is_empty(folder_ / "results"));
  }

  static MeasuredPlane clean_plane() {
    const TemporaryFolder folder;
    World world(folder.path());
    EXPECT_TRUE(world.scan());
    return measured_plane(world.options.model.path);
  }

  TemporaryFolder folder_;
  World world_{folder_.path()};
};

TEST_F(ScanWithFaults, AnExposureThatFailsIsMadeAgain) {
  world_.camera.failing_exposures = {5};
  const ScanReport report = scan_well(world_);
  EXPECT_EQ(report.shooting.shots, world_patterns);
  EXPECT_EQ(report.shooting.troubles, std::vector<std::string>{"camera: no shutter"});
  EXPECT_EQ(world_.camera.opens(), 2);
}

TEST_F(ScanWithFaults, APictureThatIsLostIsTakenAgain) {
  for (const int shot : {0, 1, 7, world_patterns - 1}) {
    SCOPED_TRACE(shot);
    World world(folder_.path());
    world.camera.failing_fetches = {shot};
    const ScanReport report = scan_well(world);
    EXPECT_EQ(report.shooting.shots, world_patterns);
    EXPECT_EQ(report.shooting.troubles, std::vector<std::string>{"camera: lost"});
  }
}

TEST_F(ScanWithFaults, FailuresCountAnewAfterAShotThatWorked) {
  world_.camera.failing_exposures = {2, 3, 6, 7, 10, 11};
  EXPECT_EQ(scan_well(world_).shooting.troubles.size(), 6U);
}

TEST_F(ScanWithFaults, ACameraThatFailsAsOftenAsThereAreAttemptsEndsTheScan) {
  world_.camera.failing_exposures = {4, 5, 6};
  scan_in_vain("camera: no shutter");
  EXPECT_EQ(world_.camera.shots(), 7);
}

TEST_F(ScanWithFaults, ACameraThatIsAwayForAWhileGoesOnWhereItStopped) {
  world_.camera.failing_fetches = {8};
  world_.camera.failing_opens = 2;
  world_.patience = {};  // as in a station: tries once a second
  const ScanReport report = scan_well(world_);
  EXPECT_EQ(report.shooting.shots, world_patterns);
  EXPECT_GT(report.shooting.recovery_ms, 1900);
  EXPECT_LT(report.shooting.recovery_ms, 4000);
}

TEST_F(ScanWithFaults, ACameraThatStaysAwayEndsTheScan) {
  world_.camera.failing_fetches = {8};
  world_.camera.failing_opens = 1'000'000;
  scan_in_vain("camera: nothing answers");
}

TEST_F(ScanWithFaults, ACameraWithAProblemEndsTheScanBeforeAnyLight) {
  world_.camera.problem = "the mode dial is not on M";
  scan_in_vain("camera Fake: the mode dial is not on M");
  EXPECT_EQ(world_.projector.lit_flips(), 0);
}

TEST_F(ScanWithFaults, APictureOfTheShotBeforeIsTakenAgain) {
  for (int shot = 1; shot < world_patterns; ++shot) {
    SCOPED_TRACE(shot);
    World world(folder_.path());
    world.camera.stale_shots = {shot};
    EXPECT_EQ(scan_well(world).refused.size(), 1U);
  }
}

TEST_F(ScanWithFaults, ACameraThatIsOutOfStepFromThenOnGivesTheSameModel) {
  for (int shot = 1; shot < world_patterns; ++shot) {
    SCOPED_TRACE(shot);
    World world(folder_.path());
    world.camera.out_of_step_from = shot;
    EXPECT_GE(scan_well(world).refused.size(), 1U);
  }
}

// The first picture is one of the dark, from before the scan.
TEST_F(ScanWithFaults, ACameraThatIsOutOfStepFromTheBeginningGivesTheSameModel) {
  world_.camera.out_of_step_from = 0;
  EXPECT_GE(scan_well(world_).refused.size(), 1U);
}

TEST_F(ScanWithFaults, AnOverexposedShotIsMadeAgain) {
  for (int shot = 0; shot < world_patterns; ++shot) {
    if (shot == 1) continue;  // black is still dark
    SCOPED_TRACE(shot);
    World world(folder_.path());
    world.camera.overexposed_shots = {shot};
    EXPECT_EQ(scan_well(world).refused.size(), 1U);
  }
}

TEST_F(ScanWithFaults, OverexposedShotsAllTheTimeEndTheScan) {
  for (int shot = 0; shot < 100; ++shot) world_.camera.overexposed_shots.push_back(shot);
  scan_in_vain("over-exposed");
}

TEST_F(ScanWithFaults, ProjectorThatVanishesAndComesBack) {
  for (const int flip : {0, 1, 2, 7, 14, 15}) {
    SCOPED_TRACE(flip);
    World world(folder_.path());
    world.projector.gone_at_flip = flip;
    world.projector.failing_opens = 2;
    const ScanReport report = scan_well(world);
    EXPECT_EQ(report.shooting.troubles, std::vector<std::string>{"HDMI-A-1: gone"});
  }
}

TEST_F(ScanWithFaults, AProjectorThatStaysAwayEndsTheScan) {
  world_.projector.gone_at_flip = 5;
  world_.projector.failing_opens = 1'000'000;
  scan_in_vain("HDMI-A-1: gone");
}

TEST_F(ScanWithFaults, AProjectorThatComesBackInAnotherModeEndsTheScan) {
  world_.projector.gone_at_flip = 5;
  world_.projector.failing_opens = 1'000'000;
  world_.projector.reason = "HDMI-A-1: 800 x 600 at 60 Hz, the calibration is for 64 x 48";
  scan_in_vain("800 x 600 at 60 Hz");
}

TEST_F(ScanWithFaults, TheNextScanWorks) {
  world_.camera.failing_exposures = {4, 5, 6};
  scan_in_vain("camera: no shutter");
  scan_well(world_);
}

}  // namespace
}  // namespace bodyscan
