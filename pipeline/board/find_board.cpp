#include "pipeline/board/find_board.hpp"

#include "pipeline/base/median.hpp"
#include "pipeline/board/board_pictures.hpp"
#include "pipeline/board/board_search.hpp"
#include "pipeline/board/corner_refinement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace bodyscan {
namespace {

using Eigen::Vector2d;

constexpr double too_little_change = 0.2;  // of the light, between a pair's pictures

// Share of saturated pixels between the outermost corners.
double saturated_share(const FloatImage& image, const ChessboardCorners& board) {
  Vector2d low = Vector2d::Constant(std::numeric_limits<double>::max());
  Vector2d high = -low;
  for (const auto& corner : board.corners) {
    if (!corner) continue;
    low = low.cwiseMin(*corner);
    high = high.cwiseMax(*corner);
  }
  std::size_t white = 0;
  std::size_t count = 0;
  for (int y = std::max(0, static_cast<int>(low.y()));
       y < std::min<int>(image.height(), static_cast<int>(high.y())); ++y) {
    for (int x = std::max(0, static_cast<int>(low.x()));
         x < std::min<int>(image.width(), static_cast<int>(high.x())); ++x) {
      white += image(x, y) >= saturated ? 1 : 0;
      ++count;
    }
  }
  return count > 0 ? static_cast<double>(white) / static_cast<double>(count) : 0;
}

Expected<void> check_exposure(const FloatImage& image, const ChessboardCorners& board, const char* what) {
  const double white = saturated_share(image, board);
  if (white <= overexposed_share) return {};
  return input_error(std::string(what) + ": over-exposed, " + std::to_string(std::lround(100 * white)) +
                     " % of it is pure white");
}

Expected<FoundBoard> refined(const FloatImage& image, const FloatImage* weight,
                             const ChessboardCorners& rough, const char* what) {
  FoundBoard found{refine_corners(image, weight, rough), 0};
  if (found.corners.found() < min_found * rough.columns * rough.rows)
    return input_error(std::string(what) + ": only " + std::to_string(found.corners.found()) + " of " +
                       std::to_string(rough.columns * rough.rows) +
                       " corners hold at full size: blurred or too dark");
  found.edge_blur_px = edge_blur_px(image, found.corners);
  return found;
}

float median_of(const FloatImage& image) {
  return median(std::vector<float>(image.pixels().begin(), image.pixels().end()));
}

}  // namespace

Expected<FoundBoard> find_printed_board(const Luma& picture, const PrintedBoard& board) {
  constexpr const char* what = "printed board";
  const FloatImage image = encoded(picture);
  const int factor = search_factor(image.size());
  const FloatImage small = reduced(image, factor);
  const auto rough = search_board(small, board.columns, board.rows, what);
  if (!rough) return input_error(rough.error().message + light_hint(small));
  if (const auto exposed = check_exposure(small, *rough, what); !exposed)
    return tl::unexpected(exposed.error());
  return refined(image, nullptr, enlarged(*rough, factor), what);
}

Expected<FoundBoard> find_projected_board(const Luma& printed, const Luma& projected,
                                          const FoundBoard& printed_board, const ProjectedBoard& board) {
  constexpr const char* what = "projected board";
  const FloatImage earlier = linear(printed);
  const FloatImage later = linear(projected);
  const int factor = search_factor(earlier.size());
  const FloatImage small_ratio = ratio_of(reduced(later, factor), reduced(earlier, factor));
  const auto on_ratio = search_board(small_ratio, board.columns, board.rows, what);
  const FloatImage image = encoded(projected);
  if (on_ratio) {
    if (const auto exposed = check_exposure(reduced(image, factor), *on_ratio, what); !exposed)
      return tl::unexpected(exposed.error());
    const FloatImage trust = trust_in(earlier);
    auto found = refined(ratio_of(later, earlier), &trust, enlarged(*on_ratio, factor), what);
    if (found) return found;
  }
  const auto on_picture = search_board(reduced(image, factor), board.columns, board.rows, what,
                                       known_corners(printed_board.corners, factor));
  if (on_picture) return refined(image, nullptr, enlarged(*on_picture, factor), what);
  const std::string dark = median_of(small_ratio) < same_light_level * too_little_change ? " (too dark)" : "";
  const std::string hint = dark.empty() ? light_hint(reduced(image, factor)) : dark;
  return input_error((on_ratio ? on_picture.error() : on_ratio.error()).message + hint);
}

}  // namespace bodyscan
