#include "pipeline/board/corner_refinement.hpp"

#include "pipeline/base/median.hpp"
#include "pipeline/board/sampling.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <Eigen/LU>

namespace bodyscan {
namespace {

using Eigen::Vector2d;

constexpr int max_iterations = 20;
constexpr double converged_px = 1e-3;
constexpr double max_walk = 0.7;        // of the half window
constexpr double min_roundness = 0.05;  // of the gradients: 4 det / trace^2, 1 where all directions are alike
constexpr double window_share = 1.0 / 6;  // of a square, half a window
constexpr double min_half_window = 3;

bool inside(const FloatImage& image, const Vector2d& at, double margin) {
  return at.x() >= margin && at.y() >= margin && at.x() < image.width() - 1 - margin &&
         at.y() < image.height() - 1 - margin;
}

// One step from `at`; nothing where the window shows no corner. Pixels as they are, the window's rim fading
// over a pixel: interpolated gradients pull corners towards pixel centres.
std::optional<Vector2d> step(const FloatImage& image, const FloatImage* weight, const Vector2d& at,
                             int half) {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Vector2d right = Vector2d::Zero();
  const double fade = 1 / (0.5 * half * half);
  const auto inside_rim = [&](double d) { return std::clamp(half + 1 - std::abs(d), 0.0, 1.0); };
  const int left = static_cast<int>(std::floor(at.x())) - half;
  const int top = static_cast<int>(std::floor(at.y())) - half;
  for (int y = top; y <= top + 2 * half + 1; ++y) {
    for (int x = left; x <= left + 2 * half + 1; ++x) {
      const Vector2d offset = Vector2d(x, y) - at;
      const Vector2d gradient(static_cast<double>(image(x + 1, y) - image(x - 1, y)) / 2,
                              static_cast<double>(image(x, y + 1) - image(x, y - 1)) / 2);
      double w = std::exp(-fade * offset.squaredNorm()) * inside_rim(offset.x()) * inside_rim(offset.y());
      if (weight != nullptr) w *= static_cast<double>((*weight)(x, y));
      const Eigen::Matrix2d outer = w * gradient * gradient.transpose();
      normal += outer;
      right += outer * offset;
    }
  }
  const double trace = normal.trace();
  const double determinant = normal.determinant();
  if (!(trace > 0) || determinant < min_roundness * trace * trace / 4) return std::nullopt;
  return Vector2d(at + normal.inverse() * right);
}

// Calls visit(corner, next corner) for neighbours along rows and columns.
template <class Visit>
void for_each_pair(const ChessboardCorners& board, Visit visit) {
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      const auto& here = board.at(column, row);
      if (!here) continue;
      if (column + 1 < board.columns && board.at(column + 1, row)) visit(*here, *board.at(column + 1, row));
      if (row + 1 < board.rows && board.at(column, row + 1)) visit(*here, *board.at(column, row + 1));
    }
  }
}

double local_square_px(const ChessboardCorners& board, int column, int row) {
  double sum = 0;
  int count = 0;
  const auto& here = *board.at(column, row);
  const auto add = [&](int c, int r) {
    if (c < 0 || r < 0 || c >= board.columns || r >= board.rows || !board.at(c, r)) return;
    sum += (*board.at(c, r) - here).norm();
    ++count;
  };
  add(column - 1, row);
  add(column + 1, row);
  add(column, row - 1);
  add(column, row + 1);
  return count > 0 ? sum / count : square_px(board);
}

// Blur of the edge that crosses the middle between two corners, from how steep it is.
std::optional<double> blur_between(const FloatImage& image, const Vector2d& a, const Vector2d& b) {
  const Vector2d along = b - a;
  const double reach = 0.3 * along.norm();
  const Vector2d across = Vector2d(-along.y(), along.x()).normalized();
  const Vector2d middle = (a + b) / 2;
  if (!inside(image, middle, reach + 2)) return std::nullopt;
  const auto at = [&](double t) { return sample(image, middle + t * across); };
  double steepest = 0;
  for (double t = -reach; t <= reach; t += 0.5)
    steepest = std::max(steepest, std::abs(at(t + 1) - at(t - 1)) / 2);
  const double height = std::abs(at(reach) - at(-reach));
  if (steepest <= 0 || height <= 0) return std::nullopt;
  return height / (std::sqrt(2 * std::numbers::pi) * steepest);
}

}  // namespace

std::optional<Vector2d> refine_corner(const FloatImage& image, const FloatImage* weight,
                                      const Vector2d& start, double half_window) {
  const int half = std::max(2, static_cast<int>(std::lround(half_window)));
  Vector2d at = start;
  for (int i = 0; i < max_iterations; ++i) {
    if (!inside(image, at, half + 2)) return std::nullopt;
    const auto next = step(image, weight, at, half);
    if (!next || (*next - start).norm() > max_walk * half) return std::nullopt;
    const double moved = (*next - at).norm();
    at = *next;
    if (moved < converged_px) return at;
  }
  return std::nullopt;
}

ChessboardCorners refine_corners(const FloatImage& image, const FloatImage* weight,
                                 const ChessboardCorners& board) {
  ChessboardCorners refined = board;
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      const auto& corner = board.at(column, row);
      if (!corner) continue;
      const double half = std::max(min_half_window, window_share * local_square_px(board, column, row));
      refined.corners[static_cast<std::size_t>(row * board.columns + column)] =
          refine_corner(image, weight, *corner, half);
    }
  }
  return refined;
}

double edge_blur_px(const FloatImage& image, const ChessboardCorners& board) {
  std::vector<double> blurs;
  for_each_pair(board, [&](const Vector2d& a, const Vector2d& b) {
    if (const auto blur = blur_between(image, a, b)) blurs.push_back(*blur);
  });
  return median(std::move(blurs));
}

double square_px(const ChessboardCorners& board) {
  double sum = 0;
  int count = 0;
  for_each_pair(board, [&](const Vector2d& a, const Vector2d& b) {
    sum += (a - b).norm();
    ++count;
  });
  return count > 0 ? sum / count : 0;
}

}  // namespace bodyscan
