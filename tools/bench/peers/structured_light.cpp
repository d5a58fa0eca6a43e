// OpenCV's structured_light module: GrayCodePattern over rows and columns, then cv::triangulatePoints.
// CAPTURE_DIR (both axes) CALIBRATION MODEL.wrl
#include "tools/bench/peers/capture.hpp"

#include <cstdio>
#include <exception>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/structured_light.hpp>

namespace {

constexpr int shadow_threshold = 10;  // grey levels, white minus black

cv::Mat load(const std::string& file) {
  cv::Mat image = cv::imread(file, cv::IMREAD_GRAYSCALE);
  if (image.empty()) throw std::runtime_error(file + ": no image");
  return image;
}

// In the module's order: columns then rows, coarsest first, each with its inverse.
std::vector<cv::Mat> load_patterns(const peer::Capture& capture) {
  std::vector<cv::Mat> images;
  for (const bool rows : {false, true}) {
    if (capture.bits(rows) == 0) throw std::runtime_error("the module needs rows and columns");
    for (int bit = capture.bits(rows) - 1; bit >= 0; --bit) {
      images.push_back(load(capture.gray.at({rows, bit, false})));
      images.push_back(load(capture.gray.at({rows, bit, true})));
    }
  }
  return images;
}

void run(const std::string& folder, const std::string& calibration, const std::string& model) {
  const peer::Capture capture = peer::read_capture(folder);
  const peer::Rig rig = peer::read_rig(calibration);
  const auto pattern =
      cv::structured_light::GrayCodePattern::create(capture.projector.width, capture.projector.height);
  const std::vector<cv::Mat> images = load_patterns(capture);
  const cv::Mat white = cv::imread(capture.white, cv::IMREAD_COLOR);
  cv::Mat lit;
  cv::subtract(load(capture.white), load(capture.black), lit);

  std::vector<cv::Point2f> camera;
  std::vector<cv::Point2f> projector;
  std::vector<cv::Vec3b> colors;
  for (int y = 0; y < lit.rows; ++y) {
    for (int x = 0; x < lit.cols; ++x) {
      cv::Point seen;
      if (lit.at<uchar>(y, x) <= shadow_threshold || pattern->getProjPixel(images, x, y, seen)) continue;
      camera.emplace_back(static_cast<float>(x), static_cast<float>(y));
      projector.emplace_back(seen);
      colors.push_back(white.at<cv::Vec3b>(y, x));
    }
  }

  std::vector<cv::Point3f> points;
  if (!camera.empty()) {
    cv::undistortPoints(camera, camera, rig.camera, rig.camera_distortion);
    cv::undistortPoints(projector, projector, rig.projector, rig.projector_distortion);
    const cv::Matx34d camera_matrix = cv::Matx34d::eye();
    cv::Matx34d projector_matrix;
    cv::hconcat(rig.rotation, rig.translation, projector_matrix);
    cv::Mat homogeneous;
    cv::triangulatePoints(camera_matrix, projector_matrix, camera, projector, homogeneous);
    cv::convertPointsFromHomogeneous(homogeneous.t(), points);
  }
  peer::write_points(model, points, colors);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) {
    std::fputs("usage: bodyscan-peer-structured-light CAPTURE_DIR CALIBRATION MODEL.wrl\n", stderr);
    return 2;
  }
  try {
    run(arguments[1], arguments[2], arguments[3]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
  return 0;
}
