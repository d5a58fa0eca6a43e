#include "tools/simulator/obj_file.hpp"

#include "tools/simulator/image_files.hpp"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

namespace bodyscan::simulator {
namespace {

namespace fs = std::filesystem;

class ObjFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              (std::string("simulator_obj_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  std::string refusal(const std::string& text) {
    const Expected<Subject> subject = read_obj(write("bad.obj", text));
    return subject ? "accepted" : subject.error().message;
  }

  fs::path folder_;
};

TEST_F(ObjFile, CentresAndTurnsIntoTheCamerasAxes) {
  const Subject subject = read_obj(write("a.obj", "v 1 2 3\nv 3 2 3\nv 3 6 5\nf 1 2 3\n")).value();
  ASSERT_EQ(subject.mesh.points.size(), 3U);
  EXPECT_LT((subject.mesh.points[0] - Eigen::Vector3d(-1, 2, 1)).norm(), 1e-12);
  EXPECT_LT((subject.mesh.points[2] - Eigen::Vector3d(1, -2, -1)).norm(), 1e-12);
  EXPECT_EQ(subject.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}}));
}

TEST_F(ObjFile, FansPolygonsAndCountsFromTheEnd) {
  const Subject subject =
      read_obj(write("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf -4 -3 -2 -1\n")).value();
  EXPECT_EQ(subject.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
}

TEST_F(ObjFile, ReadsVertexColoursAsSrgb) {
  const Subject subject =
      read_obj(write("a.obj", "v 0 0 0 1 0.5 0\r\nv 1 0 0\r\nv 1 1 0 0 0 1\r\nf 1 2 3\r\n")).value();
  EXPECT_NEAR(subject.mesh.albedo[0].y(), 0.2140, 1e-3);
  EXPECT_NEAR(subject.mesh.albedo[1].y(), 0.82, 1e-6);
  EXPECT_NEAR(subject.mesh.albedo[2].z(), 1, 1e-6);
}

TEST_F(ObjFile, ReadsMaterialsAndTextures) {
  ASSERT_TRUE(write_png(folder_ / "skin picture.png", ColorImage8({4, 2}, Rgb8{10, 20, 30})));
  write("m.mtl", "newmtl red\nKd 1 0 0\nnewmtl painted\nmap_Kd skin picture.png\n");
  const Subject subject =
      read_obj(write("a.obj",
                     "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\n"
                     "usemtl red\nf 1//1 2//1 3//1\nusemtl painted\nf 1/1 2/2 3/3\n"))
          .value();
  const TriangleMesh& mesh = subject.mesh;
  ASSERT_EQ(mesh.points.size(), 6U);
  EXPECT_EQ(mesh.textures_of, (std::vector<std::int32_t>{-1, 0}));
  EXPECT_EQ(mesh.albedo[0], Eigen::Vector3f(1, 0, 0));
  EXPECT_EQ(mesh.normals[0], Eigen::Vector3f(0, 0, -1));
  EXPECT_EQ(mesh.normals[3], Eigen::Vector3f(0, 0, 0));
  EXPECT_EQ(mesh.texture_at[5], Eigen::Vector2f(1, 1));
  ASSERT_EQ(mesh.textures.size(), 1U);
  EXPECT_EQ(mesh.textures[0](3, 1), (Rgb8{10, 20, 30}));
}

TEST_F(ObjFile, AMissingMaterialFileIsIgnoredAMissingTextureIsNot) {
  EXPECT_TRUE(read_obj(write("a.obj", "mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n")));
  write("m.mtl", "newmtl a\nmap_Kd none.png\n");
  EXPECT_NE(refusal("mtllib m.mtl\n").find("none.png: cannot be read"), std::string::npos);
}

TEST_F(ObjFile, AnErrorNamesFileLineAndReason) {
  EXPECT_NE(refusal("v 0 0 0\nv 1 x 0\n").find("bad.obj: line 2: not a finite number"), std::string::npos);
  EXPECT_NE(refusal("v 0 0 nan\n").find("line 1: not a finite number"), std::string::npos);
  EXPECT_NE(refusal("v 0 0\n").find("too few numbers"), std::string::npos);
  EXPECT_NE(refusal("v 0 0 0\nf 1 1 2\n").find("line 2: no such index: 2"), std::string::npos);
  EXPECT_NE(refusal("v 0 0 0\nf 1 0 1\n").find("no such index: 0"), std::string::npos);
  EXPECT_NE(refusal("v 0 0 0\nf 1 1\n").find("fewer than three corners"), std::string::npos);
  EXPECT_NE(refusal("v 0 0 0\nf /1 1 1\n").find("line 2"), std::string::npos);
  EXPECT_NE(refusal("v 0 0 0\n").find("holds no faces"), std::string::npos);
  EXPECT_NE(read_obj(folder_ / "none.obj").error().message.find("none.obj: cannot be read"),
            std::string::npos);
}

}  // namespace
}  // namespace bodyscan::simulator
