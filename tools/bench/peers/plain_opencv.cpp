// The thesis's method in plain OpenCV: threshold each pattern against its inverse, Gray code to an integer
// row, intersect the camera's ray with the row's light plane. CAPTURE_DIR CALIBRATION MODEL.wrl
#include "tools/bench/peers/capture.hpp"

#include <cstdio>
#include <exception>
#include <limits>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace {

constexpr int least_difference = 5;  // grey levels, OpenCV structured_light's default white threshold

cv::Mat load(const std::string& file) {
  cv::Mat image = cv::imread(file, cv::IMREAD_GRAYSCALE);
  if (image.empty()) throw std::runtime_error(file + ": no image");
  return image;
}

struct Frames {
  cv::Mat white;
  cv::Mat black;
  std::vector<cv::Mat> patterns;  // coarsest first
  std::vector<cv::Mat> inverses;
};

Frames load_all(const peer::Capture& capture, bool rows) {
  Frames frames{load(capture.white), load(capture.black), {}, {}};
  for (int bit = capture.bits(rows) - 1; bit >= 0; --bit) {
    frames.patterns.push_back(load(capture.gray.at({rows, bit, false})));
    frames.inverses.push_back(load(capture.gray.at({rows, bit, true})));
  }
  return frames;
}

// Row (or column) index per pixel and the mask of pixels where every bit is clear.
void decode(const Frames& frames, int count, cv::Mat& index, cv::Mat& valid) {
  cv::Mat difference;
  cv::subtract(frames.white, frames.black, difference);
  cv::threshold(difference, valid, 2 * least_difference, 255, cv::THRESH_BINARY);
  index = cv::Mat::zeros(frames.white.size(), CV_16U);
  cv::Mat previous = cv::Mat::zeros(frames.white.size(), CV_8U);
  for (std::size_t i = 0; i < frames.patterns.size(); ++i) {
    cv::Mat bit;
    cv::compare(frames.patterns[i], frames.inverses[i], bit, cv::CMP_GT);
    cv::absdiff(frames.patterns[i], frames.inverses[i], difference);
    valid &= difference > least_difference;
    bit ^= previous;  // Gray to binary
    bit.copyTo(previous);
    const double weight = static_cast<double>(1 << (frames.patterns.size() - 1 - i)) / 255;
    cv::scaleAdd(cv::Mat(cv::Mat_<ushort>(bit)), weight, index, index);
  }
  valid &= index < count;
}

// The light plane of a projector row in the camera frame: normal . x = offset.
struct LightPlane {
  cv::Vec3d normal;
  double offset;
};

std::vector<LightPlane> light_planes(const peer::Rig& rig, cv::Size projector, bool rows) {
  const int count = rows ? projector.height : projector.width;
  const cv::Vec3d center = -(rig.rotation.t() * rig.translation);
  std::vector<cv::Point2d> middle(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    middle[static_cast<std::size_t>(i)] =
        rows ? cv::Point2d(projector.width / 2.0, i) : cv::Point2d(i, projector.height / 2.0);
  }
  cv::undistortPoints(middle, middle, rig.projector, rig.projector_distortion);
  std::vector<LightPlane> planes;
  for (const cv::Point2d& point : middle) {
    const cv::Vec3d along = rows ? cv::Vec3d(1, 0, 0) : cv::Vec3d(0, 1, 0);
    const cv::Vec3d normal = rig.rotation.t() * cv::Vec3d(point.x, point.y, 1).cross(along);
    planes.push_back({normal, normal.dot(center)});
  }
  return planes;
}

void run(const std::string& folder, const std::string& calibration, const std::string& model) {
  const peer::Capture capture = peer::read_capture(folder);
  const peer::Rig rig = peer::read_rig(calibration);
  const bool rows = capture.bits(true) > 0;
  const Frames frames = load_all(capture, rows);
  const cv::Mat color = cv::imread(capture.white, cv::IMREAD_COLOR);
  cv::Mat index;
  cv::Mat valid;
  decode(frames, rows ? capture.projector.height : capture.projector.width, index, valid);

  std::vector<cv::Point> pixels;
  cv::findNonZero(valid, pixels);
  std::vector<cv::Point2f> rays;
  cv::Mat(pixels).convertTo(rays, CV_32FC2);
  if (!rays.empty()) cv::undistortPoints(rays, rays, rig.camera, rig.camera_distortion);
  const std::vector<LightPlane> planes = light_planes(rig, capture.projector, rows);
  std::vector<cv::Point3f> points;
  std::vector<cv::Vec3b> colors;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const LightPlane& plane = planes[index.at<ushort>(pixels[i])];
    const cv::Vec3d ray(rays[i].x, rays[i].y, 1);
    const double depth = plane.offset / plane.normal.dot(ray);
    if (!(depth > 0) || depth > 1e5) continue;
    points.emplace_back(ray * depth);
    colors.push_back(color.at<cv::Vec3b>(pixels[i]));
  }
  peer::write_points(model, points, colors);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) {
    std::fputs("usage: bodyscan-peer-plain CAPTURE_DIR CALIBRATION MODEL.wrl\n", stderr);
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
