#include "hal/drm/output_choice.hpp"

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

const DisplayMode xga{{1024, 768}, 60};
const DisplayMode xga_exact{{1024, 768}, 60.004};
const DisplayMode xga_75{{1024, 768}, 75.03};
const DisplayMode hd{{1280, 720}, 60};

const ProjectorOutput panel{"DP-1", "ELO 0a01 77", {{{1280, 800}, 59.81}, hd}};
const ProjectorOutput projector{"HDMI-A-1", "NEC 4a21 1234567", {xga_exact, xga_75}};
const ProjectorOutput second_projector{"HDMI-A-3", "NEC 4a21 7654321", {xga_exact}};
const ProjectorOutput empty{"HDMI-A-2", "", {}};
const std::vector<ProjectorOutput> kiosk{panel, projector, empty};

std::string error_of(const std::vector<ProjectorOutput>& outputs, const ProjectorChoice& choice) {
  const Expected<ProjectorChoice> chosen = choose_output(outputs, choice);
  if (chosen) return "chose " + chosen->connector;
  EXPECT_EQ(chosen.error().kind, ErrorKind::device);
  return chosen.error().message;
}

TEST(ChooseOutput, ByConnectorByEdidOrByMode) {
  for (const ProjectorChoice& choice :
       {ProjectorChoice{"HDMI-A-1", "NEC 4a21 1234567", xga}, ProjectorChoice{"HDMI-A-1", "", xga},
        ProjectorChoice{"", "NEC 4a21 1234567", xga}, ProjectorChoice{"", "", xga}}) {
    const Expected<ProjectorChoice> chosen = choose_output(kiosk, choice);
    ASSERT_TRUE(chosen) << chosen.error().message;
    EXPECT_EQ(chosen->connector, "HDMI-A-1");
    EXPECT_EQ(chosen->edid, "NEC 4a21 1234567");
    EXPECT_EQ(chosen->mode, xga_exact);
  }
}

TEST(ChooseOutput, NoSuchConnector) {
  EXPECT_EQ(error_of(kiosk, {"VGA-1", "", xga}),
            "needs a projector at VGA-1, but there is no such connector; plugged in: DP-1: ELO 0a01 77, "
            "HDMI-A-1: NEC 4a21 1234567, HDMI-A-2: nothing");
  EXPECT_EQ(error_of({}, {"VGA-1", "", xga}),
            "needs a projector at VGA-1, but there is no such connector; plugged in: no connectors");
}

TEST(ChooseOutput, NothingPluggedIn) {
  EXPECT_EQ(error_of(kiosk, {"HDMI-A-2", "NEC 4a21 1234567", xga}),
            "needs the projector NEC 4a21 1234567 at HDMI-A-2, but nothing is plugged in; plugged in: DP-1: "
            "ELO 0a01 77, HDMI-A-1: NEC 4a21 1234567, HDMI-A-2: nothing");
  EXPECT_EQ(error_of({empty}, {"", "", xga}),
            "needs a projector, but nothing is plugged in; plugged in: HDMI-A-2: nothing");
}

TEST(ChooseOutput, AnotherDevice) {
  EXPECT_EQ(error_of({panel, empty}, {"DP-1", "NEC 4a21 1234567", xga}),
            "needs the projector NEC 4a21 1234567 at DP-1; plugged in: DP-1: ELO 0a01 77, HDMI-A-2: nothing");
  EXPECT_EQ(error_of({panel}, {"", "NEC 4a21 1234567", xga}),
            "needs the projector NEC 4a21 1234567; plugged in: DP-1: ELO 0a01 77");
}

TEST(ChooseOutput, AnotherMode) {
  EXPECT_EQ(error_of(kiosk, {"HDMI-A-1", "", {{1280, 800}, 60}}),
            "needs 1280 x 800 at 60 Hz, the mode of the calibration; NEC 4a21 1234567 at HDMI-A-1 offers "
            "1024 x 768 at 60 Hz, 1024 x 768 at 75.03 Hz");
  EXPECT_EQ(error_of({{"HDMI-A-1", "NEC 4a21", {}}}, {"", "", xga}),
            "needs 1024 x 768 at 60 Hz, the mode of the calibration; NEC 4a21 at HDMI-A-1 offers no mode");
  EXPECT_EQ(error_of({panel, projector}, {"", "", {{640, 480}, 60}}),
            "needs 640 x 480 at 60 Hz, the mode of the calibration; ELO 0a01 77 at DP-1 offers 1280 x 800 at "
            "59.81 Hz, 1280 x 720 at 60 Hz, NEC 4a21 1234567 at HDMI-A-1 offers 1024 x 768 at 60 Hz, "
            "1024 x 768 at 75.03 Hz");
}

TEST(ChooseOutput, SeveralFit) {
  EXPECT_EQ(error_of({projector, second_projector}, {"", "", xga}),
            "needs a projector, and several fit: name the connector; plugged in: HDMI-A-1: NEC 4a21 1234567, "
            "HDMI-A-3: NEC 4a21 7654321");
  EXPECT_EQ(error_of({projector, second_projector}, {"", "NEC 4a21 7654321", xga}), "chose HDMI-A-3");
}

TEST(FindMode, TakesTheNearestRefreshRate) {
  const DisplayMode ntsc{{1280, 720}, 59.94};
  EXPECT_EQ(find_mode({ntsc, hd}, {{1280, 720}, 60}), hd);
  EXPECT_EQ(find_mode({ntsc, hd}, {{1280, 720}, 59.94}), ntsc);
  EXPECT_EQ(find_mode({ntsc}, {{1280, 720}, 60}), ntsc);
  EXPECT_EQ(find_mode({xga_75}, xga), std::nullopt);
  EXPECT_EQ(find_mode({}, xga), std::nullopt);
}

TEST(CheckUnchanged, TellsWhatChanged) {
  const auto error = [](const ProjectorOutput& now) {
    const Expected<void> unchanged = check_unchanged(projector, now, xga_exact);
    return unchanged ? "unchanged" : unchanged.error().message;
  };
  EXPECT_EQ(error(projector), "unchanged");
  EXPECT_EQ(error({"HDMI-A-1", "", {}}), "was unplugged or switched off");
  EXPECT_EQ(error({"HDMI-A-1", "ELO 0a01 77", {xga_exact}}),
            "ELO 0a01 77 is plugged in instead of NEC 4a21 1234567");
  EXPECT_EQ(error({"HDMI-A-1", "NEC 4a21 1234567", {hd, xga_exact}}),
            "changed its mode: it asks for 1280 x 720 at 60 Hz, and was opened when it asked for 1024 x 768 "
            "at 60 Hz");
  EXPECT_EQ(error({"HDMI-A-1", "NEC 4a21 1234567", {}}),
            "changed its mode: it asks for no mode, and was opened when it asked for 1024 x 768 at 60 Hz");
  EXPECT_EQ(check_unchanged(projector, {"HDMI-A-1", projector.edid, {xga_exact}}, xga_75).error().message,
            "no longer offers 1024 x 768 at 75.03 Hz");
}

}  // namespace
}  // namespace bodyscan
