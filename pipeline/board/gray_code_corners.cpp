#include "pipeline/board/gray_code_corners.hpp"

#include "pipeline/base/median.hpp"
#include "pipeline/board/corner_refinement.hpp"
#include "pipeline/board/homography.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <Eigen/LU>

namespace bodyscan {
namespace {

using Eigen::Vector2d;

constexpr double reach_squares = 0.5;      // about a corner
constexpr std::size_t most_pixels = 4000;  // more do not make it better
constexpr std::size_t fewest_pixels = 30;
constexpr double min_sigma_px = 0.02;
constexpr double outlier_sigmas = 4;
constexpr double min_found = 0.6;  // share of the corners

// Decoded pixels about a corner: camera px relative to it, projector px.
struct Neighbourhood {
  std::vector<Vector2d> camera;
  std::vector<Vector2d> projector;
  std::vector<double> weight;
  int quadrants = 0;  // of the four about the corner, those that hold a pixel
};

Neighbourhood pixels_about(const Vector2d& corner, double reach, const Correspondence& found) {
  Neighbourhood near;
  const FloatImage& rows = found.rows->coordinate;
  const FloatImage& columns = found.columns->coordinate;
  const int left = std::max(0, static_cast<int>(corner.x() - reach));
  const int right = std::min(rows.width() - 1, static_cast<int>(corner.x() + reach));
  const int top = std::max(0, static_cast<int>(corner.y() - reach));
  const int bottom = std::min(rows.height() - 1, static_cast<int>(corner.y() + reach));
  const int step =
      std::max(1, static_cast<int>(std::sqrt(4 * reach * reach / static_cast<double>(most_pixels))));
  unsigned quadrants = 0;
  for (int y = top; y <= bottom; y += step) {
    for (int x = left; x <= right; x += step) {
      const Vector2d offset = Vector2d(x, y) - corner;
      if (offset.norm() > reach || std::isnan(rows(x, y)) || std::isnan(columns(x, y))) continue;
      near.camera.push_back(offset);
      near.projector.emplace_back(static_cast<double>(columns(x, y)), static_cast<double>(rows(x, y)));
      const double sigma = std::hypot(static_cast<double>(found.rows->sigma(x, y)),
                                      static_cast<double>(found.columns->sigma(x, y)));
      near.weight.push_back(1 / (sigma * sigma + min_sigma_px * min_sigma_px));
      quadrants |= 1U << ((offset.x() > 0 ? 1 : 0) + (offset.y() > 0 ? 2 : 0));
    }
  }
  for (unsigned bit = 0; bit < 4; ++bit) near.quadrants += (quadrants >> bit) & 1U ? 1 : 0;
  return near;
}

// Leaves out what does not lie on the plane that the rest lie on.
void drop_outliers(Neighbourhood& near, const Eigen::Matrix3d& homography) {
  std::vector<double> lengths;
  for (std::size_t i = 0; i < near.camera.size(); ++i)
    lengths.push_back((apply_homography(homography, near.camera[i]) - near.projector[i]).norm());
  const double limit = outlier_sigmas * median(lengths) / std::sqrt(2 * std::log(2.0)) + 1e-6;
  for (std::size_t i = 0; i < lengths.size(); ++i)
    if (lengths[i] > limit) near.weight[i] = 0;
}

struct Mapped {
  Vector2d at;
  bool mirrored;
};

std::optional<Mapped> map_corner(Neighbourhood near) {
  if (near.camera.size() < fewest_pixels || near.quadrants < 2) return std::nullopt;
  auto homography = fit_homography(near.camera, near.projector, near.weight);
  if (!homography) return std::nullopt;
  drop_outliers(near, *homography);
  homography = fit_homography(near.camera, near.projector, near.weight);
  if (!homography) return std::nullopt;
  const Vector2d at = apply_homography(*homography, Vector2d::Zero());
  if (!at.allFinite()) return std::nullopt;
  return Mapped{at, homography->determinant() / std::pow((*homography)(2, 2), 3) < 0};
}

}  // namespace

Expected<std::vector<SeenCorner>> corners_in_projector(const ChessboardCorners& corners,
                                                       const Correspondence& correspondence) {
  if (!correspondence.rows || !correspondence.columns)
    return input_error("a calibration needs stripes along rows and columns");
  const double reach = reach_squares * square_px(corners);
  std::vector<SeenCorner> seen;
  int mirrored = 0;
  for (std::size_t i = 0; i < corners.corners.size(); ++i) {
    if (!corners.corners[i]) continue;
    const auto mapped = map_corner(pixels_about(*corners.corners[i], reach, correspondence));
    if (!mapped) continue;
    seen.push_back({static_cast<int>(i), mapped->at});
    mirrored += mapped->mirrored;
  }
  if (2 * mirrored > static_cast<int>(seen.size()))
    return input_error("the pictures are mirrored: left and right are swapped between camera and projector");
  if (static_cast<double>(seen.size()) < min_found * corners.found())
    return input_error("the projector's stripes are decoded at " + std::to_string(seen.size()) + " of " +
                       std::to_string(corners.found()) + " printed corners: too dark, or not lit");
  return seen;
}

}  // namespace bodyscan
