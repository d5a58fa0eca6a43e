#include "pipeline/model/vrml_writer.hpp"

#include "pipeline/model/vrml_reader.hpp"
#include "tests/pipeline/model/model_test_support.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_files.hpp"

#include <clocale>
#include <csignal>
#include <limits>
#include <locale>

#include <gtest/gtest.h>
#include <sys/resource.h>

namespace bodyscan {
namespace {

const Mesh triangle = {.points = {{0, 0, 1000}, {0, 1.5F, 1000}, {-2.25F, 0, 1000.125F}},
                       .colors = {{255, 0, 0}, {0, 128, 0}, {0, 0, 255}},
                       .faces = {{0, 1, 2}}};

void expect_same(const Mesh& read, const Mesh& written) {
  EXPECT_EQ(read.points, written.points);
  EXPECT_EQ(read.colors, written.colors);
  EXPECT_EQ(read.faces, written.faces);
}

TEST(VrmlWriter, WritesExactlyThis) {
  const TemporaryFolder folder;
  const ModelInfo info = {
      .calibration = "lab \"A\"", .software = "bodyscan 1.2", .comment = "", .closed = false};
  ASSERT_TRUE(write_model(folder / "model.wrl", triangle, info));
  EXPECT_EQ(read_text(folder / "model.wrl"), R"(#VRML V2.0 utf8
WorldInfo {
  title "bodyscan model"
  info [
    "unit: points in millimetres, the Transform makes metres of them"
    "calibration: lab 'A'"
    "software: bodyscan 1.2"
    "comment: "
  ]
}
Transform {
  rotation 1 0 0 3.14159265
  scale 0.001 0.001 0.001
  children Shape {
    appearance Appearance { material Material { } }
    geometry IndexedFaceSet {
coord Coordinate { point [
0 0 1000
0 1.5 1000
-2.25 0 1000.125
] }
color Color { color [
1 0 0
0 0.502 0
0 0 1
] }
colorPerVertex TRUE
solid FALSE
coordIndex [
0 1 2 -1
]
    }
  }
}
)");
}

TEST(VrmlWriter, MakesAPointCloudOfAMeshWithoutFaces) {
  const TemporaryFolder folder;
  Mesh cloud = triangle;
  cloud.faces.clear();
  ASSERT_TRUE(write_model(folder / "cloud.wrl", cloud, {}));
  const std::string text = read_text(folder / "cloud.wrl");
  EXPECT_NE(text.find("geometry PointSet {\ncoord Coordinate { point [\n0 0 1000\n"), std::string::npos);
  EXPECT_TRUE(text.ends_with("0 0 1\n] }\n    }\n  }\n}\n"));
  for (const char* field : {"IndexedFaceSet", "coordIndex", "solid", "colorPerVertex"}) {
    EXPECT_EQ(text.find(field), std::string::npos) << field;
  }
  const auto read = read_model(folder / "cloud.wrl");
  ASSERT_TRUE(read) << read.error().message;
  expect_same(read->mesh, cloud);
}

TEST(VrmlWriter, RoundTripsInfoAndClosedSurfacesWithoutColors) {
  const TemporaryFolder folder;
  Mesh plain = triangle;
  plain.colors.clear();
  const ModelInfo info = {
      .calibration = "a/b \xC3\xA4", .software = "bodyscan 0.1.0", .comment = "left arm", .closed = true};
  ASSERT_TRUE(write_model(folder / "model.wrl", plain, info));
  const auto read = read_model(folder / "model.wrl");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->info, info);
  expect_same(read->mesh, plain);
  EXPECT_EQ(read_text(folder / "model.wrl").find("Color {"), std::string::npos);
}

// 150,000 points and 300,000 faces: several blocks and batches of each array.
TEST(VrmlWriter, RoundTripsManyBlocksWhateverTheSizeOfTheCalls) {
  const TemporaryFolder folder;
  const Mesh mesh = relief(500, 300);
  ASSERT_TRUE(write_model(folder / "whole.wrl", mesh, {}));
  const auto read = read_model(folder / "whole.wrl");
  ASSERT_TRUE(read) << read.error().message;
  expect_same(read->mesh, mesh);

  auto writer = VrmlWriter::create(folder / "pieces.wrl", VrmlGeometry::face_set, {});
  ASSERT_TRUE(writer);
  const auto pieces = [](auto items, std::size_t size, auto write) {
    for (std::span rest(items); !rest.empty(); rest = rest.subspan(std::min(size, rest.size()))) {
      ASSERT_TRUE(write(rest.first(std::min(size, rest.size()))));
    }
  };
  pieces(std::span(mesh.points), 500, [&](auto part) { return writer->write_points(part); });
  pieces(std::span(mesh.colors), 1499, [&](auto part) { return writer->write_colors(part); });
  pieces(std::span(mesh.faces), 70001, [&](auto part) { return writer->write_faces(part); });
  ASSERT_TRUE(writer->finish());
  EXPECT_EQ(read_text(folder / "pieces.wrl"), read_text(folder / "whole.wrl"));
}

struct GermanNumbers : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(VrmlWriter, IsIndependentOfTheLocale) {
  const TemporaryFolder folder;
  Mesh mesh = relief(40, 30);
  ASSERT_TRUE(write_model(folder / "classic.wrl", mesh, {}));
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new GermanNumbers));
  const std::string c_locale = std::setlocale(LC_ALL, nullptr);
  for (const char* name : {"de_DE.UTF-8", "de_DE", "fr_FR.UTF-8"}) {
    if (std::setlocale(LC_ALL, name) != nullptr) break;
  }
  const auto written = write_model(folder / "german.wrl", mesh, {});
  const auto read = read_model(folder / "german.wrl");
  std::setlocale(LC_ALL, c_locale.c_str());
  std::locale::global(before);
  ASSERT_TRUE(written && read);
  EXPECT_EQ(read_text(folder / "german.wrl"), read_text(folder / "classic.wrl"));
  expect_same(read->mesh, mesh);
}

std::string failure_of(const TemporaryFolder& folder, const Mesh& mesh) {
  const auto written = write_model(folder / "model.wrl", mesh, {});
  if (written) return "written";
  EXPECT_EQ(written.error().kind, ErrorKind::output);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  const std::string prefix = (folder / "model.wrl").string() + ": ";
  EXPECT_TRUE(written.error().message.starts_with(prefix)) << written.error().message;
  return written.error().message.substr(prefix.size());
}

TEST(VrmlWriter, RefusesWhatCannotBeAModelAndLeavesNothing) {
  const TemporaryFolder folder;
  Mesh mesh = relief(300, 200);
  mesh.points[50000].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(failure_of(folder, mesh), "point 50000: not finite or farther away than 100 m");
  mesh = triangle;
  mesh.points[0].z = std::numeric_limits<float>::infinity();
  EXPECT_EQ(failure_of(folder, mesh), "point 0: not finite or farther away than 100 m");
  mesh = relief(300, 200);
  mesh.faces[100000][2] = 60000;
  EXPECT_EQ(failure_of(folder, mesh), "face 100000: an index without a point, or the same one twice");
  mesh = triangle;
  mesh.colors.pop_back();
  EXPECT_EQ(failure_of(folder, mesh), "2 colors for 3 points");
  EXPECT_EQ(failure_of(folder, Mesh{}), "a model without points");
}

TEST(VrmlWriter, KeepsTheOrderOfItsStates) {
  const TemporaryFolder folder;
  const auto create = [&](VrmlGeometry geometry) {
    auto writer = VrmlWriter::create(folder / "model.wrl", geometry, {});
    EXPECT_TRUE(writer && writer->write_points(triangle.points));
    return std::move(*writer);
  };
  const auto expect_failure = [&](const Expected<void>& result, const std::string& reason) {
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().message, (folder / "model.wrl").string() + ": " + reason);
  };
  {
    VrmlWriter writer = create(VrmlGeometry::face_set);
    ASSERT_TRUE(writer.write_colors(triangle.colors));
    expect_failure(writer.write_points(triangle.points), "cannot write points in state colors");
    expect_failure(writer.finish(), "cannot write finished in state failed");
  }
  {
    VrmlWriter writer = create(VrmlGeometry::face_set);
    ASSERT_TRUE(writer.write_faces(triangle.faces));
    expect_failure(writer.write_colors(triangle.colors), "cannot write colors in state faces");
  }
  {
    VrmlWriter writer = create(VrmlGeometry::face_set);
    expect_failure(writer.finish(), "a face set without faces");
  }
  {
    VrmlWriter writer = create(VrmlGeometry::point_cloud);
    expect_failure(writer.write_faces(triangle.faces), "faces in a point cloud");
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  VrmlWriter writer = create(VrmlGeometry::point_cloud);
  ASSERT_TRUE(writer.finish());
  expect_failure(writer.finish(), "cannot write finished in state finished");
}

TEST(VrmlWriter, RefusesTextThatTheReaderWouldRefuse) {
  const TemporaryFolder folder;
  ModelInfo info;
  info.comment = std::string(65001, 'x');
  const auto written = write_model(folder / "model.wrl", triangle, info);
  ASSERT_FALSE(written);
  EXPECT_TRUE(written.error().message.ends_with("model.wrl: a comment of more than 65000 bytes"));
  info.comment.pop_back();
  ASSERT_TRUE(write_model(folder / "model.wrl", triangle, info));
  const auto read = read_model(folder / "model.wrl");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->info, info);
}

TEST(VrmlWriter, NamesAFolderThatDoesNotExist) {
  const TemporaryFolder folder;
  const auto written = write_model(folder / "no/model.wrl", triangle, {});
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, ErrorKind::output);
  EXPECT_TRUE(written.error().message.ends_with("no/model.wrl: cannot create: No such file or directory"))
      << written.error().message;
}

TEST(VrmlWriter, TellsOfAFullDisk) {
  const auto written = write_model("/dev/full", relief(300, 200), {});
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, ErrorKind::output);
  EXPECT_EQ(written.error().message, "/dev/full: cannot write: No space left on device");
}

TEST(VrmlWriter, LeavesNothingWhereTheFileCannotGrow) {
  const TemporaryFolder folder;
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{.rlim_cur = 3'000'000, .rlim_max = before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string failure = failure_of(folder, relief(500, 300));
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(failure, "cannot write: File too large");
}

TEST(VrmlWriter, KeepsTheOldFileWhenTheNewOneFails) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_model(folder / "model.wrl", triangle, {}));
  const std::string before = read_text(folder / "model.wrl");
  Mesh broken = triangle;
  broken.faces[0][0] = 3;
  EXPECT_FALSE(write_model(folder / "model.wrl", broken, {}));
  EXPECT_EQ(read_text(folder / "model.wrl"), before);
}

}  // namespace
}  // namespace bodyscan
