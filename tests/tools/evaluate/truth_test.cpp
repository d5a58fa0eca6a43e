#include "tools/evaluate/truth.hpp"

#include "tools/evaluate/deviation.hpp"
#include "tools/simulator/capture_folder.hpp"

#include <cmath>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

namespace bodyscan {
namespace {

// A small capture that the simulator renders once for all tests.
class SimulatedTruth : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::filesystem::path(testing::TempDir()) / ("bodyscan_truth_" + std::to_string(getpid()));
    simulator::RenderOptions options;
    options.subject = "builtin:spheres";
    options.rig.scale = 0.06;
    options.output = folder_;
    const auto rendered = simulator::render_capture(options);
    ASSERT_TRUE(rendered) << rendered.error().message;
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(folder_); }

  static std::filesystem::path folder_;
};
std::filesystem::path SimulatedTruth::folder_;

TEST_F(SimulatedTruth, ItsMapsItsMeshAndItsFactsAreOneSurface) {
  const Expected<Truth> truth = read_truth(folder_);
  ASSERT_TRUE(truth) << truth.error().message;
  ASSERT_EQ(truth->facts.spheres.size(), 2U);
  ASSERT_EQ(truth->facts.planes.size(), 1U);
  std::size_t surface = 0;
  for (const Point3f& at : truth->points.pixels()) {
    if (at.z == 0) continue;
    ++surface;
    const Eigen::Vector3d point(at.x, at.y, at.z);
    ASSERT_NEAR(truth->surface.signed_distance(point, 1), 0, 0.002);
  }
  EXPECT_GT(surface, 3000U);

  std::size_t on_shapes = 0;
  std::size_t reachable = 0;
  for (std::size_t i = 0; i < truth->reachable.size().area(); ++i) {
    if (!truth->reachable.data()[i]) continue;
    ++reachable;
    const Point3f& at = truth->points.data()[i];
    const Eigen::Vector3d point(at.x, at.y, at.z);
    const double off = std::min({std::abs(truth->facts.planes[0].plane.distance(point)),
                                 std::abs(truth->facts.spheres[0].distance(point)),
                                 std::abs(truth->facts.spheres[1].distance(point))});
    if (off < 0.005) ++on_shapes;
  }
  EXPECT_EQ(on_shapes, reachable);
}

TEST_F(SimulatedTruth, ThePerfectModelIsPerfect) {
  const Expected<Truth> truth = read_truth(folder_);
  ASSERT_TRUE(truth) << truth.error().message;
  std::vector<Point3f> points;
  for (const Point3f& at : truth->points.pixels()) {
    if (at.z > 0) points.push_back(at);
  }
  const Deviations deviations = measure_deviations(*truth, points);
  EXPECT_LT(summarize(deviations.distance).rms, 1e-4);
  EXPECT_EQ(share_wrong(deviations), 0);
  EXPECT_EQ(measure_coverage(*truth, deviations).completeness(), 1);
}

TEST_F(SimulatedTruth, MissingOrDamagedPartsAreNamed) {
  const std::filesystem::path damaged = folder_ / "damaged";
  const std::filesystem::path truth = damaged / "truth";
  for (const char* part : {"depth.pfm", "normal.pfm", "reachable.png", "scene.json", "mesh.obj"}) {
    std::filesystem::create_directories(damaged);
    std::filesystem::copy(folder_ / "calibration.yml", damaged / "calibration.yml");
    std::filesystem::copy(folder_ / "truth", truth);
    std::ofstream(truth / part) << "f 1 2 3";
    const Expected<Truth> read = read_truth(damaged);
    ASSERT_FALSE(read) << part;
    EXPECT_NE(read.error().message.find(part), std::string::npos) << read.error().message;
    std::filesystem::remove(truth / part);
    EXPECT_FALSE(read_truth(damaged)) << part;
    std::filesystem::remove_all(damaged);
  }
}

}  // namespace
}  // namespace bodyscan
