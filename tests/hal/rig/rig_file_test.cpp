#include "hal/rig/rig_file.hpp"

#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_files.hpp"

#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

constexpr std::string_view full = R"(# station 2
calibration = "calibration.yml"
[camera]
backend = "replay"
port = "usb:001,005"
folder = "/captures/one"
exposure_us = 66666
iso = 400
aperture = 5.6
picture = [4288, 2848]
[projector]
backend = "virtual"
card = "/dev/dri/card1"
connector = "HDMI-A-1"
socket = "run/projector"
edid = "NEC 4a21 1234567"
refresh_hz = 59.94
settle_ms = 200
[scan]
patterns = "both"
attempts = 5
max_motion_mm = 0.5
max_light_s = 90
)";

constexpr std::string_view smallest = R"(calibration = "c.yml"
[camera]
backend = "gphoto2"
[projector]
backend = "drm"
)";

std::string replaced(std::string_view from, std::string_view to) {
  std::string text(full);
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string message(std::string_view text) {
  const auto rig = parse_rig(text, "rig.toml", "/station");
  return rig ? "accepted" : rig.error().message;
}

TEST(ParseRig, ReadsEveryKey) {
  const auto rig = parse_rig(full, "rig.toml", "/station");
  ASSERT_TRUE(rig) << rig.error().message;
  EXPECT_EQ(rig->calibration, "/station/calibration.yml");
  EXPECT_EQ(rig->camera.backend, CameraBackend::replay);
  EXPECT_EQ(rig->camera.port, "usb:001,005");
  EXPECT_EQ(rig->camera.folder, "/captures/one");
  EXPECT_EQ(rig->camera.settings, (CameraSettings{66666, 400, 5.6, {4288, 2848}}));
  EXPECT_EQ(rig->projector.backend, ProjectorBackend::virtual_socket);
  EXPECT_EQ(rig->projector.card, "/dev/dri/card1");
  EXPECT_EQ(rig->projector.connector, "HDMI-A-1");
  EXPECT_EQ(rig->projector.socket, "/station/run/projector");
  EXPECT_EQ(rig->projector.edid, "NEC 4a21 1234567");
  EXPECT_EQ(rig->projector.refresh_hz, 59.94);
  EXPECT_EQ(rig->projector.settle_ms, 200);
  EXPECT_EQ(rig->scan.patterns, PatternChoice::both);
  EXPECT_EQ(rig->scan.attempts, 5);
  EXPECT_EQ(rig->scan.max_motion_mm, 0.5);
  EXPECT_EQ(rig->scan.max_light_s, 90);
}

TEST(ParseRig, WhatIsNotSaidKeepsItsDefault) {
  const auto rig = parse_rig(smallest, "rig.toml", "");
  ASSERT_TRUE(rig) << rig.error().message;
  EXPECT_EQ(rig->calibration, "c.yml");
  EXPECT_EQ(rig->camera.backend, CameraBackend::gphoto2);
  EXPECT_EQ(rig->camera.port, "");
  EXPECT_EQ(rig->camera.folder, "");
  EXPECT_EQ(rig->camera.settings, CameraSettings{});
  EXPECT_EQ(rig->projector.backend, ProjectorBackend::drm);
  EXPECT_EQ(rig->projector.socket, "");
  EXPECT_EQ(rig->projector.refresh_hz, ProjectorConfig{}.refresh_hz);
  EXPECT_EQ(rig->projector.settle_ms, ProjectorConfig{}.settle_ms);
  EXPECT_EQ(rig->scan.patterns, PatternChoice::rows);
  EXPECT_EQ(rig->scan.attempts, ScanConfig{}.attempts);
  EXPECT_EQ(rig->scan.max_motion_mm, ScanConfig{}.max_motion_mm);
  EXPECT_EQ(rig->scan.max_light_s, ScanConfig{}.max_light_s);
}

struct Damage {
  std::string_view from;
  std::string_view to;
  std::string_view message;  // behind "rig.toml: "
};

constexpr Damage damages[] = {
    // missing
    {"calibration = \"calibration.yml\"", "", "calibration: is missing"},
    {"backend = \"replay\"", "", "camera.backend: is missing"},
    {"backend = \"virtual\"", "", "projector.backend: is missing"},
    {"folder = \"/captures/one\"", "", "camera.folder: is missing"},
    {"socket = \"run/projector\"", "", "projector.socket: is missing"},
    // unknown
    {"calibration =", "colour = 1\ncalibration =", "colour: is not known"},
    {"iso =", "ISO =", "camera.ISO: is not known"},
    {"card =", "gpu =", "projector.gpu: is not known"},
    {"attempts =", "tries =", "scan.tries: is not known"},
    {"[scan]", "[scans]", "scans: is not known"},
    {"\"replay\"", "\"webcam\"", "camera.backend: 'webcam' is not known; there are: gphoto2, replay"},
    {"\"replay\"", "\"\"", "camera.backend: '' is not known; there are: gphoto2, replay"},
    {"\"virtual\"", "\"Virtual\"", "projector.backend: 'Virtual' is not known; there are: drm, virtual"},
    {"\"both\"", "\"diagonals\"",
     "scan.patterns: 'diagonals' is not known; there are: rows, columns, both, fast"},
    // of another type
    {"\"calibration.yml\"", "5", "calibration: must be a text in quotes"},
    {"\"replay\"", "1", "camera.backend: must be a text in quotes"},
    {"\"usb:001,005\"", "1979-05-27", "camera.port: must be a text in quotes"},
    {"\"/captures/one\"", "[\"/captures/one\"]", "camera.folder: must be a text in quotes"},
    {"iso = 400", "iso = 400.0", "camera.iso: must be a whole number"},
    {"iso = 400", "iso = \"400\"", "camera.iso: must be a whole number"},
    {"aperture = 5.6", "aperture = \"f/5.6\"", "camera.aperture: must be a number"},
    {"aperture = 5.6", "aperture = true", "camera.aperture: must be a number"},
    {"[4288, 2848]", "4288", "camera.picture: must be [width, height], each 1 to 16384"},
    {"[4288, 2848]", "[4288]", "camera.picture: must be [width, height], each 1 to 16384"},
    {"[4288, 2848]", "[1, 2, 3]", "camera.picture: must be [width, height], each 1 to 16384"},
    {"[4288, 2848]", "[4288, 2848.0]", "camera.picture: must be [width, height], each 1 to 16384"},
    {"[scan]", "[[scan]]", "scan: must be a table, [scan]"},
    {"calibration =", "scan = 3\ncalibration =",
     "line 20: Error while parsing table header: cannot redefine existing integer 'scan' as table"},
    // empty
    {"\"calibration.yml\"", "\"\"", "calibration: must not be empty"},
    {"\"/captures/one\"", "\"\"", "camera.folder: must not be empty"},
    {"\"run/projector\"", "\"\"", "projector.socket: must not be empty"},
    // out of range
    {"66666", "99", "camera.exposure_us: 99 is not between 100 and 10000000"},
    {"66666", "9223372036854775807",
     "camera.exposure_us: 9223372036854775807 is not between 100 and 10000000"},
    {"400", "-400", "camera.iso: -400 is not between 50 and 102400"},
    {"5.6", "0.5", "camera.aperture: 0.5 is not between 0.7 and 64"},
    {"5.6", "nan", "camera.aperture: nan is not between 0.7 and 64"},
    {"[4288, 2848]", "[0, 2848]", "camera.picture: must be [width, height], each 1 to 16384"},
    {"[4288, 2848]", "[4288, 16385]", "camera.picture: must be [width, height], each 1 to 16384"},
    {"59.94", "inf", "projector.refresh_hz: inf is not between 10 and 1000"},
    {"settle_ms = 200", "settle_ms = -1", "projector.settle_ms: -1 is not between 0 and 5000"},
    {"attempts = 5", "attempts = 0", "scan.attempts: 0 is not between 1 and 20"},
    {"0.5", "0", "scan.max_motion_mm: 0 is not between 0.01 and 1000"},
    {"90", "3601", "scan.max_light_s: 3601 is not between 1 and 3600"},
};

TEST(ParseRig, NamesEveryDamage) {
  for (const Damage& damage : damages)
    EXPECT_EQ(message(replaced(damage.from, damage.to)), "rig.toml: " + std::string(damage.message))
        << damage.to;
}

TEST(ParseRig, EveryProblemIsALineOfItsOwn) {
  EXPECT_EQ(message(R"(colour = "red"
[camera]
backend = "replay"
iso = 1
[projector]
backend = "laser"
refresh_hz = "60"
[scan]
attempts = 3.5
)"),
            "rig.toml: calibration: is missing\n"
            "rig.toml: colour: is not known\n"
            "rig.toml: camera.iso: 1 is not between 50 and 102400\n"
            "rig.toml: camera.folder: is missing\n"
            "rig.toml: projector.backend: 'laser' is not known; there are: drm, virtual\n"
            "rig.toml: projector.refresh_hz: must be a number\n"
            "rig.toml: scan.attempts: must be a whole number");
}

TEST(ParseRig, NamesMissingTablesAndWhatIsNoTable) {
  EXPECT_EQ(message(""),
            "rig.toml: calibration: is missing\n"
            "rig.toml: camera: is missing\n"
            "rig.toml: projector: is missing");
  EXPECT_EQ(message("calibration = \"c\"\ncamera = 5\nprojector = [1]"),
            "rig.toml: camera: must be a table, [camera]\n"
            "rig.toml: projector: must be a table, [projector]");
}

TEST(ParseRig, ATextThatIsNoTomlSaysWhere) {
  const auto start = [](std::string_view text) { return message(text).substr(0, 18); };
  EXPECT_EQ(start("a = 1\nb = \nc = 3"), "rig.toml: line 2: ");
  EXPECT_EQ(start("a = 1\n\na = 2"), "rig.toml: line 3: ");
  EXPECT_EQ(start("[camera\n"), "rig.toml: line 1: ");
  EXPECT_EQ(start("a = \"\xff\""), "rig.toml: line 1: ");
}

TEST(ParseRig, LettersBeyondAsciiStandInTextsAndCommentsOnly) {
  const auto rig = parse_rig(replaced("\"calibration.yml\"", "\"Prüfling.yml\"  # für Köln"), "rig.toml", "");
  ASSERT_TRUE(rig) << rig.error().message;
  EXPECT_EQ(rig->calibration, "Prüfling.yml");
  for (const std::string_view letter : {"é", "\u1681", "\u2010", "\u3001", "\ufdff"}) {
    EXPECT_NE(message(std::string(letter) + " = 1"), "accepted") << letter;
    EXPECT_NE(message("a " + std::string(letter) + "= 1"), "accepted") << letter;
  }
}

TEST(ParseRig, SurvivesDeepNesting) {
  EXPECT_NE(message("a = " + std::string(max_rig_bytes / 2, '[')), "accepted");
  std::string deep;
  while (deep.size() + 4 < max_rig_bytes) deep += "a.";
  const std::string too_long = "rig.toml: line 2: longer than 1000 bytes";
  EXPECT_EQ(message("\n" + deep + "a=1"), too_long);
  EXPECT_EQ(message("\n[" + deep + "a]"), too_long);
  deep.resize(990);
  EXPECT_NE(message("[" + deep + "a]\n" + deep + "a=1"), "accepted");
}

TEST(ReadRig, PathsStartAtTheFilesFolder) {
  const TemporaryFolder folder;
  write_text(folder / "rig.toml", std::string(full));
  const auto rig = read_rig(folder / "rig.toml");
  ASSERT_TRUE(rig) << rig.error().message;
  EXPECT_EQ(rig->calibration, folder / "calibration.yml");
  EXPECT_EQ(rig->camera.folder, "/captures/one");
  EXPECT_EQ(rig->projector.socket, folder / "run/projector");
}

TEST(ReadRig, MessagesStartWithTheFile) {
  const TemporaryFolder folder;
  const std::string path = folder / "rig.toml";
  EXPECT_EQ(read_rig(path).error().message, path + ": No such file or directory");
  write_text(path, replaced("iso = 400", "iso = 1"));
  EXPECT_EQ(read_rig(path).error().message, path + ": camera.iso: 1 is not between 50 and 102400");
  EXPECT_EQ(read_rig(path).error().kind, ErrorKind::input);
  write_text(path, std::string(max_rig_bytes + 1, '\n'));
  EXPECT_EQ(read_rig(path).error().message, path + ": 65537 bytes, over the limit of 65536");
}

}  // namespace
}  // namespace bodyscan
