#include "tests/pipeline/board/synthetic_board.hpp"

#include "pipeline/base/parallel.hpp"
#include "pipeline/board/saddle_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace bodyscan {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int rows_a_task = 16;
constexpr int fine = 3;  // a pixel's side in fine pixels: blur comes before the pixels, or edges alias
// Of a fine pixel where an edge crosses it, on a Fibonacci lattice: no two share an x or y.
constexpr int samples = 21;
constexpr int lattice_step = 13;

Vector2d map(const Matrix3d& homography, const Vector2d& point) {
  return (homography * point.homogeneous()).hnormalized();
}

enum class Square { none, dark, bright };

// Of columns + 1 x rows + 1 squares about corners at (0, 0), (1, 0), ...; that at the top left is dark.
Square square_at(const Vector2d& in_squares, int columns, int rows) {
  const int column = static_cast<int>(std::floor(in_squares.x() + 1));
  const int row = static_cast<int>(std::floor(in_squares.y() + 1));
  if (column < 0 || row < 0 || column > columns || row > rows) return Square::none;
  return (column + row) % 2 == 0 ? Square::dark : Square::bright;
}

// Light that leaves the board's plane towards a place in the picture.
class Plane {
 public:
  Plane(const PrintedBoard& board, const Matrix3d& picture_from_board, const BoardPicture& how)
      : board_(board), board_from_picture_(picture_from_board.inverse()), how_(how) {
    if (how.projected) projector_from_picture_ = how.projected->projector_from_board * board_from_picture_;
  }

  [[nodiscard]] double light(const Vector2d& px) const { return returned(px) * projected(px); }

 private:
  [[nodiscard]] double returned(const Vector2d& px) const {
    const Vector3d seen = board_from_picture_ * px.homogeneous();
    const Vector2d at = seen.hnormalized() / board_.square_mm;
    const Square square = square_at(at, board_.columns, board_.rows);
    if (square == Square::dark) return how_.black;
    const double margin = 1 + how_.margin_squares;
    const bool on_sheet = at.x() > -margin && at.y() > -margin && at.x() < board_.columns - 1 + margin &&
                          at.y() < board_.rows - 1 + margin;
    return on_sheet ? how_.white : how_.background;
  }

  [[nodiscard]] double projected(const Vector2d& px) const {
    if (!how_.projected) return 1;
    const ProjectedBoard& board = how_.projected->board;
    const Vector2d at = (map(projector_from_picture_, px) - board.first_corner_px) / board.square_px;
    return square_at(at, board.columns, board.rows) == Square::dark ? how_.projected->dark : 1;
  }

  PrintedBoard board_;
  Matrix3d board_from_picture_;
  Matrix3d projector_from_picture_ = Matrix3d::Identity();
  const BoardPicture& how_;
};

// Mean light over a square of a picture.
double light_over(const Plane& plane, const Vector2d& top_left, double side) {
  double sum = 0;
  for (int i = 0; i < samples; ++i) {
    const Vector2d within(i + 0.5, i * lattice_step % samples + 0.5);
    sum += plane.light(top_left + side / samples * within);
  }
  return sum / samples;
}

// Whether a pixel lies within one square; if so, its light.
std::optional<double> even_light(const Plane& plane, int x, int y) {
  const double middle = plane.light(Vector2d(x, y));
  for (const double dx : {-0.5, 0.5})
    for (const double dy : {-0.5, 0.5})
      if (plane.light(Vector2d(x + dx, y + dy)) != middle) return std::nullopt;
  return middle;
}

// In fine pixels.
FloatImage sharp_light(const Plane& plane, Size size) {
  FloatImage light({fine * size.width, fine * size.height});
  parallel_for(0, size.height, rows_a_task, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const std::optional<double> even = even_light(plane, x, y);
        for (int j = 0; j < fine; ++j)
          for (int i = 0; i < fine; ++i)
            light(fine * x + i, fine * y + j) = static_cast<float>(
                even ? *even
                     : light_over(plane, Vector2d(x, y) + Vector2d(i, j) / fine - Vector2d(0.5, 0.5),
                                  1.0 / fine));
      }
    }
  });
  return light;
}

FloatImage light_of(const Plane& plane, Size size, const BoardPicture& how) {
  FloatImage sharp = sharp_light(plane, size);
  const FloatImage soft =
      how.blur_px > 0 ? gaussian_blur(sharp, static_cast<float>(fine * how.blur_px)) : std::move(sharp);
  FloatImage light(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      float sum = 0;
      for (int j = 0; j < fine; ++j)
        for (int i = 0; i < fine; ++i) sum += soft(fine * x + i, fine * y + j);
      const double share = how.exposure * (1 - how.uneven * x / size.width) / (fine * fine);
      light(x, y) = static_cast<float>(share * static_cast<double>(sum));
    }
  }
  return light;
}

// Encoded grey levels of linear light in steps of full scale / 65535.
std::vector<std::uint8_t> srgb_table() {
  std::vector<std::uint8_t> table;
  for (int i = 0; i < 65536; ++i) {
    const double light = i / 65535.0;
    const double value = light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
    table.push_back(static_cast<std::uint8_t>(std::lround(255 * value)));
  }
  return table;
}

GrayImage8 developed(const FloatImage& light, const BoardPicture& how) {
  static const std::vector<std::uint8_t> table = srgb_table();
  std::mt19937 random(how.seed);
  std::normal_distribution<double> normal;
  GrayImage8 picture(light.size());
  for (int y = 0; y < light.height(); ++y) {
    for (int x = 0; x < light.width(); ++x) {
      double value = static_cast<double>(light(x, y));
      if (how.noise > 0) value += how.noise * normal(random);
      const int to = how.mirrored ? light.width() - 1 - x : x;
      picture(to, y) = table[static_cast<std::size_t>(std::lround(65535 * std::clamp(value, 0.0, 1.0)))];
    }
  }
  return picture;
}

}  // namespace

Matrix3d picture_from_board(const PrintedBoard& board, const BoardView& view) {
  constexpr double degree = std::numbers::pi / 180;
  const double axis = view.tilt_axis_degrees * degree;
  const Matrix3d rotation =
      Eigen::AngleAxisd(view.tilt_degrees * degree, Vector3d(std::cos(axis), std::sin(axis), 0)).matrix() *
      Eigen::AngleAxisd(view.roll_degrees * degree, Vector3d::UnitZ()).matrix();
  const double distance = view.focal_px * board.square_mm / view.square_px;
  const Vector2d middle_mm = board.corner_mm(board.corner_count() - 1) / 2;
  const Vector3d middle =
      distance * Vector3d(view.middle_px.x(), view.middle_px.y(), view.focal_px) / view.focal_px;
  Matrix3d camera_from_board;
  camera_from_board << rotation.leftCols<2>(), middle - rotation.leftCols<2>() * middle_mm;
  Matrix3d picture_from_camera;
  picture_from_camera << view.focal_px, 0, (view.picture.width - 1) / 2.0,  //
      0, view.focal_px, (view.picture.height - 1) / 2.0,                    //
      0, 0, 1;
  return picture_from_camera * camera_from_board;
}

Photograph photograph(const PrintedBoard& board, const Matrix3d& picture_from_board, Size size,
                      const BoardPicture& how) {
  Photograph result;
  result.picture = developed(light_of(Plane(board, picture_from_board, how), size, how), how);
  const auto seen = [&](const Vector2d& mm) {
    const Vector2d px = map(picture_from_board, mm);
    return how.mirrored ? Vector2d(size.width - 1 - px.x(), px.y()) : px;
  };
  for (int i = 0; i < board.corner_count(); ++i) result.printed.push_back(seen(board.corner_mm(i)));
  if (how.projected) {
    const Matrix3d board_from_projector = how.projected->projector_from_board.inverse();
    for (int i = 0; i < how.projected->board.corner_count(); ++i)
      result.projected.push_back(seen(map(board_from_projector, how.projected->board.corner_px(i))));
  }
  return result;
}

CornerErrors compare(const ChessboardCorners& found, const std::vector<Vector2d>& truth) {
  CornerErrors errors;
  double squares = 0;
  for (std::size_t i = 0; i < std::min(truth.size(), found.corners.size()); ++i) {
    if (!found.corners[i]) continue;
    const double error = (*found.corners[i] - truth[i]).norm();
    ++errors.found;
    squares += error * error;
    errors.worst = std::max(errors.worst, error);
  }
  errors.rms = std::sqrt(squares / std::max(1, errors.found));
  return errors;
}

std::vector<Vector2d> half_a_turn(std::vector<Vector2d> corners) {
  std::ranges::reverse(corners);
  return corners;
}

}  // namespace bodyscan
