#include "pipeline/model/vrml_reader.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

struct Damage {
  const char* name;
  std::string text;
  const char* error;
};

const std::string header = "#VRML V2.0 utf8\n";

// Line 2: points, line 3: colours, line 4: faces, line 5: further fields.
std::string face_set(const std::string& points, const std::string& colors, const std::string& faces,
                     const std::string& more = "") {
  return header + "Shape { geometry IndexedFaceSet { coord Coordinate { point [" + points +
         "] }\ncolor Color { color [" + colors + "] }\ncoordIndex [" + faces + "]\n" + more + "} }";
}

const std::string points = "0 0 1 1 0 1 1 1 1 0 1 1";
const std::string colors = "0 0 0 1 0 0 0 1 0 0 0 1";
const std::string faces = "0 1 2 -1 0 2 3 -1";
const std::string intact = face_set(points, colors, faces);

const std::vector<Damage> damages = {
    {"empty", "", "line 1: the first line is not \"#VRML V2.0 utf8\""},
    {"version_1", "#VRML V1.0 ascii\n", "line 1: the first line is not \"#VRML V2.0 utf8\""},
    {"header_run_on", "#VRML V2.0 utf8x\n", "line 1: the first line is not \"#VRML V2.0 utf8\""},
    {"header_second", "\n" + intact, "line 1: the first line is not \"#VRML V2.0 utf8\""},
    {"byte_order_mark", "\xEF\xBB\xBF" + intact, "line 1: a byte order mark before the header"},
    {"nothing", header, "line 2: no IndexedFaceSet and no PointSet"},
    {"box_only", header + "Shape { geometry Box { } }", "line 2: no IndexedFaceSet and no PointSet"},
    {"null_geometry", header + "Shape { geometry NULL }", "line 2: no IndexedFaceSet and no PointSet"},
    {"prototype", header + "PROTO P [ ] { Shape { } }", "line 2: PROTO is not supported"},
    {"external_prototype", header + "EXTERNPROTO P [ ] \"\"", "line 2: EXTERNPROTO is not supported"},
    {"use", header + "Group { children USE X }", "line 2: USE is not supported"},
    {"use_coord", header + "Shape { geometry PointSet { coord USE X } }", "line 2: USE is not supported"},
    {"second_geometry", intact + "\nShape { geometry PointSet { } }", "line 6: a second geometry"},
    {"stray_brace", intact + "\n}", "line 6: '}' found where a name is due"},
    {"stray_number", header + "5", "line 2: '5' found where a name is due"},
    {"zero_byte", intact + std::string(1, '\0'), "line 5: byte 0 found where a name is due"},
    {"zero_byte_in_points", face_set(points + std::string(1, '\0'), colors, faces),
     "line 2: byte 0 found where a number is due"},
    {"zero_byte_skipped", header + "A { " + std::string(1, '\0') + "}",
     "line 2: byte 0 found where a value is due"},
    {"wrong_node", header + "Shape { geometry PointSet { coord Color { } } }",
     "line 2: Color where Coordinate is due"},
    {"wrong_bracket", header + "A { b [ }", "line 2: '}' found where ']' is due"},
    {"wrong_brace", header + "A { b ]", "line 2: ']' found where '}' is due"},
    {"no_brace", header + "Viewpoint\nShape", "line 3: 'S' found where '{' is due"},
    {"no_bracket", header + "Shape { geometry PointSet { coord Coordinate { point 1 2 3 } } }",
     "line 2: '1' found where '[' is due"},
    {"long_name", header + std::string(257, 'a'), "line 2: a name of more than 256 bytes"},
    {"open_string", header + "WorldInfo { title\n\"a\nb }", "line 3: a string without end"},
    {"escaped_end", header + "WorldInfo { title \"a\\\" }", "line 2: a string without end"},
    {"not_boolean", face_set(points, colors, faces, "solid MAYBE"),
     "line 5: MAYBE where TRUE or FALSE is due"},

    {"no_points", face_set("", "", faces), "line 5: a geometry without points"},
    {"no_coord", header + "Shape { geometry PointSet { } }", "line 2: a geometry without points"},
    {"null_coord", header + "Shape { geometry PointSet { coord NULL } }",
     "line 2: a geometry without points"},
    {"half_a_point", face_set(points + " 5 6", colors, faces), "line 2: ']' found where a number is due"},
    {"points_twice",
     header + "Shape { geometry PointSet { coord Coordinate { point [ 1 2 3 ]\npoint [ 1 2 3 ] } } }",
     "line 3: points a second time"},
    {"decimal_commas", face_set("0,5 0,5 1,5 1,5 0,5 1,5", "", faces), "line 2: a decimal comma"},
    {"decimal_comma_negative", face_set("-0,5 0 0", "", faces), "line 2: a decimal comma"},
    {"not_a_number", face_set("0 nan 1 " + points, colors, faces), "line 2: 'n' found where a number is due"},
    {"minus_nan", face_set("0 -nan 1 " + points, colors, faces), "line 2: '-' found where a number is due"},
    {"infinite", face_set("0 inf 1 " + points, colors, faces), "line 2: 'i' found where a number is due"},
    {"signed_infinite", face_set("0 -Infinity 1 " + points, colors, faces),
     "line 2: '-' found where a number is due"},
    {"windows_infinite", face_set("0 1.#INF 1 " + points, colors, faces), "line 2: '#' in a number"},
    {"overflow", face_set("0 1e39 1 " + points, colors, faces), "line 2: a number out of range"},
    {"long_overflow", face_set("0 " + std::string(40, '9') + " 1", colors, faces),
     "line 2: a number out of range"},
    {"endless_number", face_set("0 " + std::string(300000, '1') + " 1", colors, faces),
     "line 2: a number out of range"},
    {"endless_fraction", face_set("0 0." + std::string(300000, '1') + " 1", colors, faces),
     "line 2: '1' in a number"},
    {"two_signs", face_set("--1 0 0", colors, faces), "line 2: '-' found where a number is due"},
    {"two_points", face_set("1.2.3 0 0", colors, faces), "line 2: '.' in a number"},
    {"lone_point", face_set(". 0 0", colors, faces), "line 2: '.' found where a number is due"},
    {"hexadecimal", face_set("0x10 0 0", colors, faces), "line 2: 'x' in a number"},
    {"open_exponent", face_set("1e 0 0", colors, faces), "line 2: 'e' in a number"},

    {"colors_missing", face_set(points, "0 0 0 1 1 1", faces), "line 5: 2 colors for 4 points"},
    {"colors_too_many", face_set(points, colors + " 1 1 1", faces), "line 5: 5 colors for 4 points"},
    {"colors_in_bytes", face_set(points, "0 0 255 1 0 0 0 1 0 0 0 1", faces),
     "line 3: a color outside 0 to 1"},
    {"color_negative", face_set(points, "0 0 -0.1", faces), "line 3: a color outside 0 to 1"},
    {"half_a_color", face_set(points, colors + " 1", faces), "line 3: ']' found where a number is due"},
    {"colors_twice", face_set(points, colors + "] color [ 0 0 0", faces), "line 3: colors a second time"},
    {"color_index", face_set(points, colors, faces, "colorIndex [ 0 1 2 -1 ]"),
     "line 5: colorIndex is not supported"},
    {"color_per_face", face_set(points, colors, faces, "colorPerVertex FALSE"),
     "line 5: colors that are not one a point"},

    {"no_faces", face_set(points, colors, ""), "line 5: an IndexedFaceSet without faces"},
    {"last_end_missing", face_set(points, colors, "0 1 2 -1 0 2 3"),
     "line 4: coordIndex does not end with -1"},
    {"index_too_large", face_set(points, colors, "0 1 2 -1\n0 2 4 -1"), "line 5: index 4 of 4 points"},
    {"index_negative", face_set(points, colors, "0 1 -2 -1"), "line 4: index -2"},
    {"index_overflow", face_set(points, colors, "0 1 4294967296 -1"), "line 4: an integer out of range"},
    {"index_wrapped", face_set(points, colors, "0 1 18446744073709551617 -1"),
     "line 4: an integer out of range"},
    {"index_fraction", face_set(points, colors, "0 1 2.0 -1"), "line 4: '.' in a number"},
    {"index_name", face_set(points, colors, "0 1 two -1"), "line 4: 't' found where an integer is due"},
    {"edge", face_set(points, colors, "0 1 -1"), "line 4: a face of fewer than three points"},
    {"lone_end", face_set(points, colors, "-1"), "line 4: a face of fewer than three points"},
    {"repeated_index", face_set(points, colors, "0 1 1 -1"), "line 4: a face with point 1 twice"},
    {"repeated_first", face_set(points, colors, "0 1 0 -1"), "line 4: a face with point 0 twice"},
    {"closed_polygon", face_set(points, colors, "0 1 2 0 -1"), "line 4: a face with point 0 twice"},
    {"faces_twice", face_set(points, colors, faces, "coordIndex [ 0 1 2 -1 ]"),
     "line 5: coordIndex a second time"},
    {"not_convex", face_set(points, colors, "0 1 2 3 -1", "convex FALSE"),
     "line 5: polygons that are not convex"},
};

class VrmlDamage : public testing::TestWithParam<Damage> {};

TEST_P(VrmlDamage, IsRefusedWithItsLine) {
  const auto model = parse_model(GetParam().text);
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().kind, ErrorKind::input);
  EXPECT_EQ(model.error().message, GetParam().error);
}

INSTANTIATE_TEST_SUITE_P(Table, VrmlDamage, testing::ValuesIn(damages),
                         [](const auto& damage) { return std::string(damage.param.name); });

TEST(VrmlDamageTable, StartsFromAnIntactFile) {
  const auto model = parse_model(intact);
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_EQ(model->mesh.faces.size(), 2U);
}

TEST(VrmlDamageTable, RefusesEveryTruncation) {
  for (std::size_t size = 0; size < intact.size(); ++size) {
    EXPECT_FALSE(parse_model(std::string_view(intact).substr(0, size))) << size;
  }
}

}  // namespace
}  // namespace bodyscan
