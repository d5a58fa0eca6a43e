#include "tests/accuracy/board.hpp"

#include "tools/evaluate/shape_fit.hpp"
#include "tools/evaluate/statistics.hpp"

#include <array>
#include <cmath>
#include <stdexcept>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace bodyscan {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double white_inset = 0.05;

std::vector<cv::Point2f> find_corners(const cv::Mat& picture, const std::string& name) {
  std::vector<cv::Point2f> corners;
  if (!cv::findChessboardCorners(picture, {Board::columns, Board::rows}, corners)) {
    throw std::runtime_error(name + ": no board found");
  }
  cv::cornerSubPix(picture, corners, {5, 5}, {-1, -1},
                   {cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 50, 1e-3});
  return corners;
}

Plane fit_trimmed_plane(std::vector<Vector3d> points, double& rms) {
  for (;;) {
    const Plane plane = fit_plane(points);
    double squares = 0;
    for (const Vector3d& point : points) squares += plane.distance(point) * plane.distance(point);
    rms = std::sqrt(squares / static_cast<double>(points.size()));
    if (std::erase_if(
            points, [&](const Vector3d& point) { return std::abs(plane.distance(point)) > 4 * rms; }) == 0) {
      return plane;
    }
  }
}

double white_share_covered(const Board& board, const Lens& camera, const Image<std::uint8_t>& has_point) {
  std::size_t white = 0;
  std::size_t covered = 0;
  for (int y = 0; y < camera.size.height; ++y) {
    for (int x = 0; x < camera.size.width; ++x) {
      if (!board.on_white(board.at(camera.ray({x, y})))) continue;
      ++white;
      covered += has_point(x, y);
    }
  }
  return white == 0 ? 0 : static_cast<double>(covered) / static_cast<double>(white);
}

}  // namespace

Board Board::find(const std::filesystem::path& picture, const Lens& camera) {
  const cv::Mat image = cv::imread(picture.string(), cv::IMREAD_GRAYSCALE);
  if (image.empty()) throw std::runtime_error(picture.string() + ": cannot be read");
  const std::vector<cv::Point2f> corners = find_corners(image, picture.string());
  std::vector<cv::Point2d> seen;
  std::vector<cv::Point2d> printed;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector3d ray = camera.ray({corners[i].x, corners[i].y});
    seen.emplace_back(ray.x(), ray.y());
    printed.emplace_back(static_cast<double>(i % columns), static_cast<double>(i / columns));
  }
  const cv::Mat homography = cv::findHomography(seen, printed);
  Board board;
  for (int i = 0; i < 9; ++i) board.board_from_ray_(i / 3, i % 3) = homography.at<double>(i / 3, i % 3);

  std::array<double, 2> brightness{};
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const Vector2d place = board.at(camera.ray({x, y}));
      if (!inside(place)) continue;
      const int parity = static_cast<int>(std::floor(place.x()) + std::floor(place.y())) & 1;
      brightness[static_cast<std::size_t>(parity)] += image.at<std::uint8_t>(y, x);
    }
  }
  board.white_parity_ = brightness[1] > brightness[0] ? 1 : 0;
  return board;
}

Vector2d Board::at(const Vector3d& ray) const {
  return (board_from_ray_ * ray).hnormalized();
}

bool Board::inside(const Vector2d& place) {
  return place.x() > 0 && place.y() > 0 && place.x() < columns - 1 && place.y() < rows - 1;
}

bool Board::on_white(const Vector2d& place) const {
  if (!inside(place)) return false;
  const Vector2d corner = place.array().floor();
  if ((static_cast<int>(corner.x() + corner.y()) & 1) != white_parity_) return false;
  const Vector2d within = place - corner;
  return within.minCoeff() > white_inset && within.maxCoeff() < 1 - white_inset;
}

BoardFigures measure_board(const Board& board, const Lens& camera, const Mesh& model, double square_mm) {
  std::vector<Vector3d> points;
  Image<std::uint8_t> has_point(camera.size, std::uint8_t{0});
  for (const Point3f& point : model.points) {
    const Vector3d place(point.x, point.y, point.z);
    if (!Board::inside(board.at(place / place.z()))) continue;
    points.push_back(place);
    const Vector2d pixel = camera.project(place);
    const int x = static_cast<int>(std::lround(pixel.x()));
    const int y = static_cast<int>(std::lround(pixel.y()));
    if (x >= 0 && y >= 0 && x < camera.size.width && y < camera.size.height) has_point(x, y) = 1;
  }
  BoardFigures figures{.points = points.size()};
  if (points.size() < 3) return figures;
  const Plane plane = fit_trimmed_plane(points, figures.plane_rms);
  std::vector<float> distances;
  for (const Vector3d& point : points) distances.push_back(static_cast<float>(plane.distance(point)));
  figures.plane_rms /= square_mm;
  figures.p95 = summarize(distances).p95 / square_mm;
  figures.white_covered = white_share_covered(board, camera, has_point);
  return figures;
}

}  // namespace bodyscan
