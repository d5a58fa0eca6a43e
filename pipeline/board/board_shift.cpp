#include "pipeline/board/board_shift.hpp"

#include "pipeline/base/median.hpp"
#include "pipeline/board/board_pictures.hpp"
#include "pipeline/board/board_search.hpp"
#include "pipeline/board/corner_refinement.hpp"
#include "pipeline/board/saddle_points.hpp"

#include <utility>
#include <vector>

namespace bodyscan {
namespace {

using Eigen::Vector2d;

constexpr double alike_share = 0.1;  // of a square: shifts that one motion of the board explains

// Median of how far corners moved that can still be made out where they were.
std::optional<double> small_shift(const FloatImage& image, const ChessboardCorners& corners) {
  const double half = square_px(corners) / 8;
  std::vector<double> shifts;
  for (const auto& corner : corners.corners) {
    if (!corner) continue;
    if (const auto now = refine_corner(image, nullptr, *corner, half))
      shifts.push_back((*now - *corner).norm());
  }
  if (shifts.size() < corners.corners.size() / 4) return std::nullopt;
  return median(shifts);
}

// The shift, up to half a square, that most corners have in common.
std::optional<double> large_shift(const FloatImage& image, const ChessboardCorners& corners) {
  const int factor = search_factor(image.size());
  const double square = square_px(corners) / factor;
  const KnownCorners known = known_corners(corners, factor);
  std::vector<Vector2d> shifts;
  for (const SaddlePoint& saddle : find_saddle_points(reduced(image, factor), {}))
    for (const Vector2d& corner : known.corners)
      if ((saddle.at - corner).norm() < square / 2) shifts.emplace_back(saddle.at - corner);
  std::vector<double> common;
  for (const Vector2d& shift : shifts) {
    std::vector<double> alike;
    for (const Vector2d& other : shifts)
      if ((other - shift).norm() < alike_share * square) alike.push_back(other.norm());
    if (alike.size() > common.size()) common = std::move(alike);
  }
  if (common.size() < known.corners.size() / 3) return std::nullopt;
  return factor * median(common);
}

}  // namespace

std::optional<double> board_shift_px(const Luma& later, const ChessboardCorners& before) {
  const FloatImage image = encoded(later);
  const auto near_by = small_shift(image, before);
  return near_by ? near_by : large_shift(image, before);
}

}  // namespace bodyscan
