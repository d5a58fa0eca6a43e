#include "pipeline/calibration/calibration_file.hpp"

#include <array>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

constexpr std::string_view good = R"(%YAML:1.0
---
# a comment
camera_size: [ 640, 480 ]
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 500., 0., 319.5,   # fx 0 cx
       0., 500., 239.5,
       0., 0., 1. ]
camera_distortion: !!opencv-matrix
   rows: 1
   cols: 5
   dt: "f"
   data: [ -1.0e-01, 2E-2, +0.001, 0, .5 ]
projector_size: [1024,768]
projector_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 900., 0., 511.5, 0., 900., 700., 0., 0., 1. ]
projector_distortion: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data: [ 0., 0., 0., 0., 0. ]
rotation: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 1., 0., 0., 0., 0.8, -0.6, 0., 0.6, 0.8 ]
translation: !!opencv-matrix
   rows: 3
   cols: 1
   dt: d
   data: [ 0., -270., 10. ]
world_from_camera: .Nan
)";

std::string replaced(std::string_view from, std::string_view to) {
  std::string text(good);
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string message(const std::string& text) {
  const auto calibration = parse_calibration(text, "calibration.yml");
  return calibration ? "accepted" : calibration.error().message;
}

TEST(ParseCalibration, ReadsEveryKey) {
  const auto parsed = parse_calibration(good, "calibration.yml");
  ASSERT_TRUE(parsed) << parsed.error().message;
  EXPECT_EQ(parsed->camera.size, (Size{640, 480}));
  EXPECT_EQ(parsed->camera.fx, 500);
  EXPECT_EQ(parsed->camera.cy, 239.5);
  EXPECT_EQ(parsed->camera.distortion, (std::array{-0.1, 0.02, 0.001, 0.0, 0.5}));
  EXPECT_EQ(parsed->projector.size, (Size{1024, 768}));
  EXPECT_EQ(parsed->projector.cx, 511.5);
  EXPECT_EQ(parsed->projector_from_camera.rotation(1, 2), -0.6);
  EXPECT_EQ(parsed->projector_from_camera.translation, Eigen::Vector3d(0, -270, 10));
}

TEST(ParseCalibration, LineEndsOfOtherSystems) {
  std::string text(good);
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.insert(at, 1, '\r');
  EXPECT_EQ(message(text), "accepted");
}

TEST(ParseCalibration, IgnoresKeysItDoesNotKnow) {
  EXPECT_EQ(
      message(std::string(good) + "nested:\n   a: 1\n   list:\n      - \"x: # y\"\nserial: \"12\"\n...\n"),
      "accepted");
}

struct Damage {
  std::string_view from;
  std::string_view to;
  std::string_view message;  // behind "calibration.yml: "
};

constexpr Damage damages[] = {
    // the document
    {"%YAML:1.0", "{\"json\": 1}", "not an OpenCV FileStorage YAML file"},
    {"%YAML:1.0", "%YAML:9.9", "not an OpenCV FileStorage YAML file"},
    {"# a comment", "rubbish", "line 3: not \"key: value\""},
    {"# a comment", "a b: 1", "line 3: not \"key: value\""},
    {"# a comment", "   5", "line 3: a value without a key"},
    {"# a comment", "camera_size: [ 1, 2 ]", "line 4: camera_size occurs twice"},
    {"# a comment", "...", "line 4: text after the end of the document"},
    // missing keys
    {"camera_size:", "camera_extent:", "camera_size: missing"},
    {"camera_matrix:", "camera:", "camera_matrix: missing"},
    {"projector_distortion:", "distortion:", "projector_distortion: missing"},
    {"rotation:", "turn:", "rotation: missing"},
    {"translation:", "shift:", "translation: missing"},
    // sizes
    {"[ 640, 480 ]", "[ 640, 0 ]", "camera_size: sides must be whole numbers in 1 to 32768"},
    {"[ 640, 480 ]", "[ -640, 480 ]", "camera_size: sides must be whole numbers in 1 to 32768"},
    {"[ 640, 480 ]", "[ 640.5, 480 ]", "camera_size: sides must be whole numbers in 1 to 32768"},
    {"[1024,768]", "[ 1e9, 768 ]", "projector_size: sides must be whole numbers in 1 to 32768"},
    {"[ 640, 480 ]", "[ 640 ]", "camera_size: not a sequence of 2 numbers"},
    {"[ 640, 480 ]", "[]", "camera_size: not a sequence of 2 numbers"},
    {"[ 640, 480 ]", "[ 640, 480, 3 ]", "camera_size: more than 2 numbers"},
    {"[ 640, 480 ]", "[ 640, 480 ] 3", "camera_size: not a sequence of 2 numbers"},
    {"[ 640, 480 ]", "[ 640 480 ]", "camera_size: a comma or ] is missing"},
    {"[ 640, 480 ]", "[ 640, 480", "camera_size: a comma or ] is missing"},
    {"[ 640, 480 ]", "640", "camera_size: not a sequence of numbers"},
    // numbers
    {"319.5", ".Nan", "camera_matrix: not finite"},
    {"319.5", "-.Inf", "camera_matrix: not finite"},
    {"319.5", "nan", "camera_matrix: not finite"},
    {"319.5", "-inf", "camera_matrix: not finite"},
    {"319.5", "1e999", "camera_matrix: '1e999' is out of range"},
    {"319.5", "319,5", "camera_matrix: more than 9 numbers"},
    {"319.5", "319.5px", "camera_matrix: '319.5px' is not a number"},
    {"319.5", "+-3", "camera_matrix: '+-3' is not a number"},
    {"319.5", "", "camera_matrix: '' is not a number"},
    {"319.5", "0x1F", "camera_matrix: '0x1F' is not a number"},
    {"-0.6, 0.", ".nan, 0.", "rotation: not finite"},
    {"-270.", ".inf", "translation: not finite"},
    {"-1.0e-01", "nan", "camera_distortion: not finite"},
    // shapes
    {"rows: 3", "rows: 4", "camera_matrix: not a 3x3 matrix"},
    {"rows: 1\n   cols: 5", "rows: 5\n   cols: 1", "camera_distortion: not a 1x5 matrix"},
    {"cols: 1\n   dt: d\n   data: [ 0., -270., 10. ]", "cols: 1\n   dt: d\n   data: [ 0., -270. ]",
     "translation: not a 3x1 matrix"},
    {"camera_matrix: !!opencv-matrix", "camera_matrix:", "camera_matrix: not an opencv-matrix"},
    {"   rows: 3\n", "", "camera_matrix: rows, cols, dt or data is missing"},
    {"   rows: 3\n", "   rows: 3\n   rows: 3\n", "camera_matrix: 'rows:' is not expected here"},
    {"   dt: d\n", "   dt: \"2d\"\n", "camera_matrix: dt: '\"2d\"' is neither d nor f"},
    {"0., 0., 1. ]", "0., 0., 1. ] ]", "camera_matrix: '' is not expected here"},
    // what the values mean
    {"[ 500., 0., 319.5", "[ 0., 0., 319.5", "camera_matrix: focal lengths must be positive"},
    {"0., 500., 239.5", "0., -500., 239.5", "camera_matrix: focal lengths must be positive"},
    {"[ 500., 0., 319.5", "[ 500., 2., 319.5", "camera_matrix: not of the form fx 0 cx, 0 fy cy, 0 0 1"},
    {"700., 0., 0., 1.", "700., 0., 0., 2.", "projector_matrix: not of the form fx 0 cx, 0 fy cy, 0 0 1"},
    {"0.8, -0.6", "0.8, -0.61", "rotation: not a rotation"},
    {"[ 1., 0., 0., 0., 0.8", "[ -1., 0., 0., 0., 0.8", "rotation: not a rotation"},
    {"[ 1., 0., 0., 0., 0.8, -0.6, 0., 0.6, 0.8 ]", "[ 0, 0, 0, 0, 0, 0, 0, 0, 0 ]",
     "rotation: not a rotation"},
    {"[ 1., 0., 0.", "[ 1e200, 0., 0.", "rotation: not a rotation"},
    {"[ 0., -270., 10. ]", "[ 0., 0., 0. ]", "translation: zero baseline"},
};

TEST(ParseCalibration, NamesEveryDamage) {
  for (const Damage& damage : damages)
    EXPECT_EQ(message(replaced(damage.from, damage.to)), "calibration.yml: " + std::string(damage.message))
        << damage.to;
}

TEST(ParseCalibration, EveryTruncationThatLosesAValueIsRefused) {
  const std::size_t last_value = good.find("world_from_camera") - 4;  // the bracket of the translation
  for (std::size_t length = 0; length < last_value; ++length)
    ASSERT_NE(message(std::string(good.substr(0, length))), "accepted") << length;
}

TEST(ParseCalibration, MessagesHoldNoControlCharacters) {
  EXPECT_EQ(message(replaced("319.5", "\x1b[31mred\x07")),
            "calibration.yml: camera_matrix: '?' is not a number");
}

}  // namespace
}  // namespace bodyscan
