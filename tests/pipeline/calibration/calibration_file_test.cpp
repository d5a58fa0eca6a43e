#include "pipeline/calibration/calibration_file.hpp"

#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_files.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace bodyscan {
namespace {

Calibration example() {
  Calibration calibration;
  calibration.camera = {{4288, 2848}, 5500.125, 5501, 2143.5, 1423.5, {-0.12, 0.1, 1e-5, -2e-17, 0}};
  calibration.projector = {{1024, 768}, 2200, 2200.1, 511.5, 790.3, {}};
  calibration.projector_from_camera.rotation =
      Eigen::AngleAxisd(0.27, Eigen::Vector3d(1, 0.1, -0.05).normalized()).toRotationMatrix();
  calibration.projector_from_camera.translation = {3.25, -268.0 / 3, 40};
  return calibration;
}

void expect_equal(const Calibration& a, const Calibration& b) {
  for (const auto& [left, right] : {std::pair{&a.camera, &b.camera}, std::pair{&a.projector, &b.projector}}) {
    EXPECT_EQ(left->size, right->size);
    EXPECT_EQ(left->fx, right->fx);
    EXPECT_EQ(left->fy, right->fy);
    EXPECT_EQ(left->cx, right->cx);
    EXPECT_EQ(left->cy, right->cy);
    EXPECT_EQ(left->distortion, right->distortion);
  }
  EXPECT_EQ(a.projector_from_camera.rotation, b.projector_from_camera.rotation);
  EXPECT_EQ(a.projector_from_camera.translation, b.projector_from_camera.translation);
}

class CalibrationFile : public testing::Test {
 protected:
  const TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "calibration.yml";
};

TEST_F(CalibrationFile, RoundTripKeepsEveryBit) {
  ASSERT_TRUE(write_calibration(example(), path_));
  const auto read = read_calibration(path_);
  ASSERT_TRUE(read) << read.error().message;
  expect_equal(*read, example());
}

TEST_F(CalibrationFile, NotesAreReadByOpenCvAndPassedOver) {
  const auto text = calibration_text(example(), {"2026-11-25T09:30:00Z", 0.125, 0.25, 0.5});
  ASSERT_TRUE(text) << text.error().message;
  const cv::FileStorage storage(*text, cv::FileStorage::READ | cv::FileStorage::MEMORY);
  EXPECT_EQ(static_cast<std::string>(storage["calibrated_at"]), "2026-11-25T09:30:00Z");
  EXPECT_EQ(static_cast<double>(storage["camera_rms_px"]), 0.125);
  EXPECT_EQ(static_cast<double>(storage["projector_rms_px"]), 0.25);
  EXPECT_EQ(static_cast<double>(storage["stereo_rms_px"]), 0.5);
  const auto read = parse_calibration(*text, "notes");
  ASSERT_TRUE(read) << read.error().message;
  expect_equal(*read, example());
  write_text(path_, *text);
  const auto notes = read_calibration_notes(path_);
  ASSERT_TRUE(notes) << notes.error().message;
  EXPECT_EQ(notes->camera_rms_px, 0.125);
  EXPECT_EQ(notes->projector_rms_px, 0.25);
  EXPECT_EQ(notes->stereo_rms_px, 0.5);
}

TEST_F(CalibrationFile, WithoutNotesSaysNothingAboutItsFit) {
  write_text(path_, *calibration_text(example()) + "camera_rms_px: small\n");
  const auto notes = read_calibration_notes(path_);
  ASSERT_TRUE(notes) << notes.error().message;
  EXPECT_FALSE(notes->camera_rms_px);
  EXPECT_FALSE(notes->projector_rms_px);
}

TEST_F(CalibrationFile, OpenCvReadsWhatWeWrite) {
  ASSERT_TRUE(write_calibration(example(), path_));
  const cv::FileStorage storage(path_.string(), cv::FileStorage::READ);
  std::vector<int> size;
  storage["camera_size"] >> size;
  EXPECT_EQ(size, (std::vector{4288, 2848}));
  cv::Mat rotation;
  storage["rotation"] >> rotation;
  ASSERT_EQ(rotation.size(), cv::Size(3, 3));
  ASSERT_EQ(rotation.type(), CV_64F);
  const Calibration calibration = example();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      EXPECT_DOUBLE_EQ(rotation.at<double>(row, column),
                       calibration.projector_from_camera.rotation(row, column));
  cv::Mat distortion;
  storage["camera_distortion"] >> distortion;
  ASSERT_EQ(distortion.size(), cv::Size(5, 1));
  EXPECT_DOUBLE_EQ(distortion.at<double>(3), -2e-17);
}

TEST_F(CalibrationFile, WeReadWhatOpenCvWrites) {
  const Calibration calibration = example();
  {
    cv::FileStorage storage(path_.string(), cv::FileStorage::WRITE);
    storage << "calibrated_at"
            << "2026-03-01T10:00:00Z # \"noon\"";
    storage << "rms" << std::vector<double>(40, 0.25);
    storage << "nested"
            << "{"
            << "a" << 1 << "list"
            << "["
            << "x"
            << "y"
            << "]"
            << "}";
    for (const auto& [device, lens] :
         {std::pair{std::string("camera"), calibration.camera}, {"projector", calibration.projector}}) {
      storage << device + "_size" << std::vector{lens.size.width, lens.size.height};
      storage << device + "_matrix"
              << cv::Mat(cv::Matx33d(lens.fx, 0, lens.cx, 0, lens.fy, lens.cy, 0, 0, 1));
      storage << device + "_distortion" << cv::Mat(1, 5, CV_64F, const_cast<double*>(lens.distortion.data()));
    }
    Eigen::Matrix3d transposed = calibration.projector_from_camera.rotation.transpose();
    storage << "rotation" << cv::Mat(3, 3, CV_64F, transposed.data());
    Eigen::Vector3d translation = calibration.projector_from_camera.translation;
    storage << "translation" << cv::Mat(3, 1, CV_64F, translation.data());
  }
  const auto read = read_calibration(path_);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->camera.size, calibration.camera.size);
  EXPECT_DOUBLE_EQ(read->camera.distortion[0], -0.12);
  EXPECT_NEAR((read->projector_from_camera.rotation - calibration.projector_from_camera.rotation).norm(), 0,
              1e-15);
  EXPECT_DOUBLE_EQ(read->projector_from_camera.translation.y(), -268.0 / 3);
}

TEST_F(CalibrationFile, WritingRefusesWhatReadingWould) {
  Calibration calibration = example();
  calibration.camera.fx = std::numeric_limits<double>::quiet_NaN();
  const auto written = write_calibration(calibration, path_);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, ErrorKind::output);
  EXPECT_EQ(written.error().message, path_.string() + ": camera_matrix: not finite");
  EXPECT_FALSE(std::filesystem::exists(path_));
}

TEST_F(CalibrationFile, MissingFileIsNamed) {
  const auto read = read_calibration(path_);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().message, path_.string() + ": No such file or directory");
}

TEST_F(CalibrationFile, AFileOverAMebibyteIsRefused) {
  std::ofstream(path_) << std::string(max_calibration_bytes + 1, '#');
  const auto read = read_calibration(path_);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().message, path_.string() + ": 1048577 bytes, over the limit of 1048576");
  EXPECT_FALSE(parse_calibration(std::string(max_calibration_bytes + 1, '#'), "name"));
}

// The values checked by check_calibration itself, which no text can express.
TEST(CheckCalibration, NamesTheKeyOfABadValue) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const auto message = [](auto change) {
    Calibration calibration = example();
    change(calibration);
    const auto good = check_calibration(calibration);
    return good ? std::string("good") : good.error().message;
  };
  EXPECT_EQ(message([](Calibration&) {}), "good");
  EXPECT_EQ(message([&](Calibration& c) { c.projector.cy = infinity; }), "projector_matrix: not finite");
  EXPECT_EQ(message([&](Calibration& c) { c.camera.distortion[4] = nan; }), "camera_distortion: not finite");
  EXPECT_EQ(message([&](Calibration& c) { c.projector_from_camera.rotation(1, 1) = nan; }),
            "rotation: not finite");
  EXPECT_EQ(message([&](Calibration& c) { c.projector_from_camera.translation.z() = nan; }),
            "translation: not finite");
  EXPECT_EQ(message([](Calibration& c) { c.camera.size.height = 0; }),
            "camera_size: sides must lie in 1 to 32768");
}

}  // namespace
}  // namespace bodyscan
