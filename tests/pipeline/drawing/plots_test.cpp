#include "pipeline/drawing/plots.hpp"

#include "tests/pipeline/drawing/sample_report.hpp"
#include "tests/pipeline/drawing/svg_reader.hpp"

#include <limits>
#include <set>
#include <string_view>

namespace bodyscan {
namespace {

using Eigen::Vector2d;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Of 4 poses with 63 corners: pose 2 is left out, one corner a pose in the camera, two in the projector.
constexpr int poses = 4;
constexpr std::size_t used_camera = 3 * 62;
constexpr std::size_t used_projector = 3 * 61;

TEST(CalibrationPlots, AreFourFilesOfWellFormedXml) {
  const SampleReport sample = sample_report(poses);
  const auto plots = calibration_plots(sample.report, sample.calibration, sample.board);
  std::set<std::string_view> names;
  for (const Plot& plot : plots) {
    names.insert(plot.file_name);
    const auto elements = read_svg(plot.svg);
    ASSERT_FALSE(elements.empty());
    EXPECT_EQ(elements[0].tag, "svg");
    EXPECT_EQ(plot.svg.find("nan"), std::string::npos) << plot.file_name;
  }
  EXPECT_EQ(names, std::set<std::string_view>(plot_file_names.begin(), plot_file_names.end()));
}

TEST(ResidualPlot, HasAnArrowForEveryUsedCornerAndAKey) {
  const SampleReport sample = sample_report(poses);
  const auto elements = read_svg(residual_plot(sample.report, sample.calibration));
  EXPECT_EQ(of_class(elements, "arrow").size(), used_camera + used_projector);
  EXPECT_EQ(of_class(elements, "key").size(), 2U);
  EXPECT_TRUE(shows(elements, "Camera, 4288 x 2848 pixels: 186 corners, 0.28 px RMS"));
  EXPECT_TRUE(shows(elements, "Projector, 1024 x 768 pixels: 183 corners, 0.29 px RMS"));
  EXPECT_TRUE(shows(elements, "pose 3"));
  EXPECT_TRUE(shows(elements, "pose 2 (left out)"));
}

TEST(ResidualPlot, ArrowsPointAlongTheErrorAtTheirPicturesKeysScale) {
  SampleReport sample = sample_report(1);
  auto& camera = sample.report.poses[0].camera;
  auto& projector = sample.report.poses[0].projector;
  camera = {{{-0.5, -0.5}, {0.3, 0}, true}, {{4287.5, 2847.5}, {0, -0.1}, true}};
  projector = {{{-0.5, -0.5}, {0, 0.3}, true}, {{1023.5, 767.5}, {-0.15, 0}, true}};
  const auto elements = read_svg(residual_plot(sample.report, sample.calibration));
  const auto arrows = of_class(elements, "arrow");
  const auto keys = of_class(elements, "key");
  ASSERT_EQ(arrows.size(), 4U);
  ASSERT_EQ(keys.size(), 2U);
  const auto start = [&](std::size_t i) { return Vector2d(arrows[i].number("x1"), arrows[i].number("y1")); };
  const auto by = [&](std::size_t i) {
    return Vector2d(Vector2d(arrows[i].number("x2"), arrows[i].number("y2")) - start(i));
  };
  const auto key = [&](std::size_t i) { return keys[i].number("x2") - keys[i].number("x1"); };

  const double height = start(1).y() - start(0).y();
  EXPECT_LT((start(1) - start(0) - height * Vector2d(4288.0 / 2848, 1)).norm(), 1e-3);
  EXPECT_GT(by(0).x(), 15);
  EXPECT_LT((by(1) - Vector2d(0, -by(0).x() / 3)).norm(), 1e-3);
  EXPECT_NEAR(by(0).y(), 0, 1e-9);
  EXPECT_NEAR(key(0) * 0.3 / by(0).x(), 0.5, 1e-3);
  EXPECT_TRUE(shows(elements, "0.5 px, 500 times enlarged"));

  EXPECT_GT(start(2).x(), start(1).x());
  EXPECT_LT((start(3) - start(2) - height * Vector2d(1024.0 / 768, 1)).norm(), 1e-3);
  EXPECT_GT(by(2).y(), 15);
  EXPECT_LT((by(3) - Vector2d(-by(2).y() / 2, 0)).norm(), 1e-3);
  EXPECT_NEAR(key(1) * 0.3 / by(2).y(), 1, 1e-3);
  EXPECT_TRUE(shows(elements, "1 px, 100 times enlarged"));
}

TEST(CoveragePlot, HasDotsAndCrossesInBothPictures) {
  const SampleReport sample = sample_report(poses);
  const auto elements = read_svg(coverage_plot(sample.report, sample.calibration));
  EXPECT_EQ(of_class(elements, "dot").size(), used_camera + used_projector);
  EXPECT_EQ(of_class(elements, "cross").size(), 2U * poses * 63 - used_camera - used_projector);
  EXPECT_TRUE(shows(elements, "Camera, 4288 x 2848 pixels: 186 corners, 66 left out"));
  EXPECT_TRUE(shows(elements, "Projector, 1024 x 768 pixels: 183 corners, 69 left out"));
}

TEST(PosePlot, HasEveryBoardAndDashesThoseLeftOut) {
  const SampleReport sample = sample_report(poses);
  const auto elements = read_svg(pose_plot(sample.report, sample.calibration, sample.board));
  EXPECT_EQ(of_class(elements, "frustum").size(), 2U);
  const auto boards = of_class(elements, "board");
  EXPECT_EQ(boards.size(), 4U);
  EXPECT_EQ(std::count_if(boards.begin(), boards.end(),
                          [](const SvgElement& board) { return board.attributes.count("stroke-dasharray"); }),
            1);
  for (const char* name : {"camera", "projector", "pose 0", "pose 1", "pose 2 (left out)", "pose 3"})
    EXPECT_TRUE(shows(elements, name)) << name;
}

TEST(PosePlot, LeavesOutABoardWithoutAPose) {
  SampleReport sample = sample_report(poses);
  sample.report.poses[0].camera_from_board = {};
  sample.report.poses[1].camera_from_board.translation.x() = nan;
  const auto elements = read_svg(pose_plot(sample.report, sample.calibration, sample.board));
  EXPECT_EQ(of_class(elements, "board").size(), 2U);
  EXPECT_FALSE(shows(elements, "pose 0"));
}

TEST(PosePlot, NamesDoNotOverlap) {
  for (const int count : {12, 25, 200}) {
    const SampleReport sample = sample_report(count);
    const auto elements = read_svg(pose_plot(sample.report, sample.calibration, sample.board));
    std::set<std::pair<double, double>> places;
    for (const SvgElement& element : elements) {
      if (element.tag != "text" || element.text.substr(0, 5) != "pose ") continue;
      const double x = element.number("x");
      const double y = element.number("y");
      EXPECT_TRUE(y > 0 && y < elements[0].number("height") && x < elements[0].number("width") - 60);
      for (const auto& [other_x, other_y] : places)
        EXPECT_TRUE(std::abs(y - other_y) > 13 || std::abs(x - other_x) > 140) << element.text;
      places.emplace(x, y);
    }
    EXPECT_EQ(places.size(), static_cast<std::size_t>(count));
  }
}

// Corners in the bars of the histogram at x in `left` to `right`, from their heights.
double corners_in_bars(const std::vector<SvgElement>& elements, double left, double right) {
  double highest = 0;
  double sum = 0;
  for (const SvgElement& bar : of_class(elements, "bar")) {
    if (bar.number("x") < left || bar.number("x") > right) continue;
    highest = std::max(highest, bar.number("height"));
    sum += bar.number("height");
  }
  return sum / highest;
}

TEST(ResidualHistogram, BarsHoldEveryUsedCorner) {
  SampleReport sample = sample_report(poses);
  for (PoseReport& pose : sample.report.poses) {
    pose.projector.clear();
    for (std::size_t i = 0; i < pose.camera.size(); ++i)
      pose.camera[i].error = i % 2 == 0 ? Eigen::Vector2d(0.09, 0.12) : Eigen::Vector2d(0.31, 0);
  }
  const auto elements = read_svg(residual_histogram(sample.report));
  // Of 62 used corners a pose 31 have each length.
  EXPECT_EQ(of_class(elements, "bar").size(), 2U);
  EXPECT_NEAR(corners_in_bars(elements, 0, 600), 2, 1e-3);
  EXPECT_TRUE(shows(elements, "Camera: 186 corners, 0.28 px RMS"));
  EXPECT_TRUE(shows(elements, "Projector: 0 corners, 0.29 px RMS"));
}

TEST(ResidualHistogram, AFewLongOnesDoNotSqueezeTheOthers) {
  SampleReport sample = sample_report(10);
  sample.report.poses[0].camera[5].error = {30, 40};
  const auto elements = read_svg(residual_histogram(sample.report));
  EXPECT_TRUE(shows(elements, "residual, px; the last bar holds 1 longer ones"));
}

TEST(CalibrationPlots, SurviveAReportOfNothingAndNumbersThatAreNone) {
  SampleReport sample = sample_report(poses);
  sample.report.camera_rms_px = nan;
  for (PoseReport& pose : sample.report.poses) {
    pose.name = "<pose> & \"board\"\n";
    for (CornerResidual& corner : pose.camera) corner.error.x() = nan;
    for (CornerResidual& corner : pose.projector) corner.at.y() = std::numeric_limits<double>::infinity();
  }
  for (const Plot& plot : calibration_plots(sample.report, sample.calibration, sample.board))
    read_svg(plot.svg);
  for (const Plot& plot : calibration_plots({}, sample.calibration, sample.board)) {
    const auto elements = read_svg(plot.svg);
    for (const char* name : {"arrow", "dot", "cross", "board", "bar"})
      EXPECT_TRUE(of_class(elements, name).empty()) << plot.file_name << " " << name;
  }
}

}  // namespace
}  // namespace bodyscan
