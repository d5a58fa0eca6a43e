#include "pipeline/model/vrml_reader.hpp"

#include "tests/pipeline/model/model_test_support.hpp"
#include "tests/support/temporary_folder.hpp"

#include <charconv>
#include <fstream>
#include <random>
#include <string>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

const std::string header = "#VRML V2.0 utf8\n";

VrmlModel parsed(const std::string& text, const VrmlLimits& limits = {}) {
  auto model = parse_model(text, limits);
  EXPECT_TRUE(model) << model.error().message;
  return model ? std::move(*model) : VrmlModel{};
}

std::string refusal(const std::string& text, const VrmlLimits& limits = {}) {
  const auto model = parse_model(text, limits);
  return model ? "accepted" : model.error().message;
}

const std::vector<Point3f> square = {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};

TEST(VrmlReader, ReadsOtherPeoplesLayout) {
  const VrmlModel model = parsed(R"(#VRML V2.0 utf8 CosmoWorlds V1.0
# exported, [ { "
NavigationInfo { type ["EXAMINE", "ANY"] headlight TRUE }
DEF Root Group {
  bboxSize 1 1 1
  children [
    DEF Light DirectionalLight { direction 0 -1 0 }
    Transform { translation 1 2 3 children [ Shape {
      appearance DEF Skin Appearance {
        material Material { diffuseColor .8 .8 .8 }
        texture ImageTexture { url "a \"quoted\" } ] name.png" }
      }
      geometry DEF Square-1 IndexedFaceSet {
        creaseAngle 3.14 texCoord NULL normalPerVertex FALSE
        coordIndex [0,1,2,3,-1]   # a fan
        color Color { color [ 1 0 0, 0 1 0, 0 0 1, 0.5 0.5 0.5 ] }
        coord DEF C Coordinate { point [ 0 0 1, 1 0 1, 1 1.0 1, +0 1e0 1, ] }
        ccw FALSE
      }
    }, NULL ] },
  ]
  ROUTE Root.a TO Light.b
}
ROUTE Root.a TO Light.b)");
  EXPECT_EQ(model.mesh.points, square);
  EXPECT_EQ(model.mesh.colors, (std::vector<Rgb8>{{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {128, 128, 128}}));
  EXPECT_EQ(model.mesh.faces, (std::vector<Face>{{0, 2, 1}, {0, 3, 2}}));
  EXPECT_TRUE(model.info.closed);
}

TEST(VrmlReader, ReadsAPointSetWithoutColors) {
  const VrmlModel model =
      parsed(header + "Shape { geometry PointSet { coord Coordinate { point [ 1 2 3 ] } } }");
  EXPECT_EQ(model.mesh.points, (std::vector<Point3f>{{1, 2, 3}}));
  EXPECT_TRUE(model.mesh.colors.empty());
  EXPECT_TRUE(model.mesh.faces.empty());
  EXPECT_FALSE(model.info.closed);
}

TEST(VrmlReader, ReadsInfoAndIgnoresOtherLines) {
  const VrmlModel model =
      parsed(header + R"(WorldInfo { title "t" info [ "x" "software: a\\b \"c\"" "comment: d
e" ] }
WorldInfo { info "calibration: f" }
Shape { geometry PointSet { coord Coordinate { point [ 1 2 3 ] } } })");
  EXPECT_EQ(model.info.software, "a\\b \"c\"");
  EXPECT_EQ(model.info.comment, "d\ne");
  EXPECT_EQ(model.info.calibration, "f");
}

TEST(VrmlReader, AcceptsCarriageReturns) {
  const VrmlModel model = parsed(
      "#VRML V2.0 utf8\r\nShape {\r\n# comment\r\ngeometry PointSet { coord Coordinate { point [\r\n1 2 "
      "3\r\n] } } }\r\n");
  EXPECT_EQ(model.mesh.points.size(), 1U);
}

// The file text that does not fit the window is moved and read on; every token is cut at some offset.
TEST(VrmlReader, ReadsTokensAcrossTheEdgeOfItsWindow) {
  const std::string shape =
      "WorldInfo { info [ \"comment: a long one\" ] } Shape { geometry IndexedFaceSet { coord Coordinate { "
      "point [ "
      "0 0 1 1 0 1 1 1 1 0 1 1 ] } solid FALSE coordIndex [ 0 1 2 -1 0 2 3 -1 ] } } # end";
  constexpr std::size_t window = std::size_t{1} << 16;
  for (std::size_t cut = 1; cut < shape.size(); ++cut) {
    std::string text = header + "#";
    text.resize(window - cut - 1, '.');
    const VrmlModel model = parsed(text + "\n" + shape);
    ASSERT_EQ(model.mesh.points, square) << cut;
    ASSERT_EQ(model.mesh.faces, (std::vector<Face>{{0, 1, 2}, {0, 2, 3}})) << cut;
    ASSERT_EQ(model.info.comment, "a long one") << cut;
  }
}

TEST(VrmlReader, ReadsNumbersAsFromCharsDoes) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> length(1, 9);
  std::uniform_int_distribution<int> digit('0', '9');
  std::vector<float> expected;
  std::string text = header + "Shape { geometry PointSet { coord Coordinate { point [";
  for (int i = 0; i < 30000; ++i) {
    std::string number = i % 2 == 0 ? "-" : "";
    for (int n = length(random); n > 0; --n) number += static_cast<char>(digit(random));
    if (i % 3 != 0) number += '.';
    for (int n = i % 3 == 0 ? 0 : length(random); n > 0; --n) number += static_cast<char>(digit(random));
    if (i % 5 == 0) number += "e-3";
    float value = 0;
    std::from_chars(number.data(), number.data() + number.size(), value);
    expected.push_back(value);
    text += i % 7 == 0 ? "\n" : " ";
    text += number;
  }
  const VrmlModel model = parsed(text + "] } } }");
  ASSERT_EQ(model.mesh.points.size(), expected.size() / 3);
  for (std::size_t i = 0; i < model.mesh.points.size(); ++i) {
    const Point3f& point = model.mesh.points[i];
    ASSERT_EQ(point, (Point3f{expected[3 * i], expected[3 * i + 1], expected[3 * i + 2]}));
  }
}

TEST(VrmlReader, KeepsItsLimits) {
  const std::string file = header + R"(WorldInfo { info "12345678" }
Shape { geometry IndexedFaceSet { coord Coordinate { point [ 0 0 1 1 0 1 1 1 1 0 1 1 ] }
color Color { color [ 0 0 1 1 0 1 1 1 1 0 1 1 ] }
coordIndex [ 0 1 2 3 -1 ] } })";
  const VrmlLimits enough = {
      .file_bytes = file.size(), .points = 4, .faces = 2, .string_bytes = 8, .nesting = 5};
  EXPECT_EQ(parsed(file, enough).mesh.points.size(), 4U);

  VrmlLimits limits = enough;
  --limits.file_bytes;
  EXPECT_EQ(refusal(file, limits), "larger than " + std::to_string(file.size() - 1) + " bytes");
  limits = enough;
  limits.points = 3;
  EXPECT_EQ(refusal(file, limits), "line 3: more than 3 points");
  limits = enough;
  limits.faces = 1;
  EXPECT_EQ(refusal(file, limits), "line 5: more than 1 faces");
  limits = enough;
  limits.string_bytes = 7;
  EXPECT_EQ(refusal(file, limits), "line 2: a string of more than 7 bytes");
  limits = enough;
  limits.nesting = 2;
  EXPECT_EQ(refusal(file, limits), "line 3: nested deeper than 2 levels");
}

TEST(VrmlReader, LimitsColorsWithoutPoints) {
  const std::string file = header + "Shape { geometry PointSet { color Color { color [ 0 0 1 1 0 1 ] } } }";
  VrmlLimits limits;
  limits.points = 1;
  EXPECT_EQ(refusal(file, limits), "line 2: more than 1 colors");
}

TEST(VrmlReader, StopsAtNestingBombs) {
  std::string groups = header;
  std::string braces = header + "Unknown ";
  std::string values = header + "Group { x ";
  for (int i = 0; i < 100000; ++i) {
    groups += "Group { children [ ";
    braces += "{ a ";
    values += "[ ";
  }
  for (const std::string& bomb : {groups, braces, values}) {
    EXPECT_EQ(refusal(bomb), "line 2: nested deeper than 32 levels");
  }
}

TEST(VrmlReader, NamesTheFile) {
  const TemporaryFolder folder;
  const auto message = [&](const char* name, const VrmlLimits& limits = {}) {
    const auto model = read_model(folder / name, limits);
    if (model) return std::string("read");
    EXPECT_EQ(model.error().kind, ErrorKind::input);
    const std::string prefix = (folder / name).string() + ": ";
    EXPECT_TRUE(model.error().message.starts_with(prefix)) << model.error().message;
    return model.error().message.substr(prefix.size());
  };
  EXPECT_EQ(message("none.wrl"), "cannot open: No such file or directory");
  EXPECT_EQ(message("."), "cannot read: Is a directory");
  std::ofstream(folder / "short.wrl") << header << "Shape {\n";
  EXPECT_EQ(message("short.wrl"), "line 3: the file ends where a name is due");
  std::ofstream(folder / "long.wrl") << header << std::string(1'000'000, ' ');
  VrmlLimits limits;
  limits.file_bytes = 999'999;
  EXPECT_EQ(message("long.wrl", limits), "larger than 999999 bytes");
}

}  // namespace
}  // namespace bodyscan
