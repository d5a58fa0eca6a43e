#include "pipeline/board/find_board.hpp"

#include "pipeline/base/median.hpp"
#include "pipeline/base/parallel.hpp"
#include "pipeline/board/corner_refinement.hpp"
#include "pipeline/decode/response.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace bodyscan {
namespace {

using Eigen::Vector2d;

constexpr int search_px = 1300;    // longer side of the picture that boards are searched in
constexpr double min_found = 0.8;  // share of the corners
constexpr float full_scale = 255;  // of the pictures searched, grey levels
constexpr float min_light = 0.3F;  // grey levels of linear light: a ratio to less is noise
constexpr float max_ratio = 4;
constexpr double hide_share = 0.2;  // of a square around a printed corner, where no other is looked for
constexpr float saturated = 254;    // grey levels
constexpr double overexposed_share = 0.25;
constexpr double alike_share = 0.1;        // of a square: shifts that one motion of the board explains
constexpr double too_dark = 12;            // grey levels, mean
constexpr double too_little_change = 0.2;  // of the light, between a pair's pictures
constexpr int rows_a_task = 32;

// Grey levels as the camera encoded them.
FloatImage encoded(const Luma& luma) {
  FloatImage image(size_of(luma));
  std::visit(
      [&](const auto& picture) {
        using Pixel = std::decay_t<decltype(picture(0, 0))>;
        constexpr float scale = full_scale / static_cast<float>(std::numeric_limits<Pixel>::max());
        for (std::size_t i = 0; i < picture.size().area(); ++i)
          image.data()[i] = scale * static_cast<float>(picture.data()[i]);
      },
      luma);
  return image;
}

// Linear light under sRGB, 0 to full_scale.
FloatImage linear(const Luma& luma) {
  FloatImage image(size_of(luma));
  std::visit(
      [&](const auto& picture) {
        using Pixel = std::decay_t<decltype(picture(0, 0))>;
        const std::vector<std::uint16_t> table = linear_table({}, 8 * sizeof(Pixel));
        const float scale = full_scale / static_cast<float>(table.back());
        for (std::size_t i = 0; i < picture.size().area(); ++i)
          image.data()[i] = scale * static_cast<float>(table[picture.data()[i]]);
      },
      luma);
  return image;
}

FloatImage reduced(const FloatImage& image, int factor) {
  if (factor == 1) return image.clone();
  FloatImage small({image.width() / factor, image.height() / factor});
  const float share = 1 / static_cast<float>(factor * factor);
  parallel_for(0, small.height(), rows_a_task, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      float* out = small.row(y);
      std::fill_n(out, small.width(), 0.0F);
      for (int j = 0; j < factor; ++j) {
        const float* row = image.row(y * factor + j);
        for (int x = 0; x < small.width(); ++x)
          for (int i = 0; i < factor; ++i) out[x] += row[x * factor + i];
      }
      for (int x = 0; x < small.width(); ++x) out[x] *= share;
    }
  });
  return small;
}

int search_factor(Size size) {
  return std::max(1, (std::max(size.width, size.height) + search_px - 1) / search_px);
}

// Positions in a picture reduced by `factor` to those in the whole.
ChessboardCorners enlarged(ChessboardCorners board, int factor) {
  for (auto& corner : board.corners)
    if (corner) *corner = factor * *corner + Vector2d::Constant((factor - 1) / 2.0);
  return board;
}

std::string size_text(int columns, int rows) {
  return std::to_string(columns) + " x " + std::to_string(rows);
}

// What a search came upon that is not the board asked for, for the message.
std::string describe(const std::vector<ChessboardCorners>& boards, int columns, int rows) {
  if (boards.empty()) return "no chessboard to be seen";
  const ChessboardCorners& best = boards.front();
  const int longer = std::max(best.columns, best.rows);
  const int shorter = std::min(best.columns, best.rows);
  const bool fits = longer <= std::max(columns, rows) && shorter <= std::min(columns, rows);
  if (best.complete() && (longer > std::max(columns, rows) || longer * shorter >= columns * rows * 7 / 10))
    return "the board seen has " + size_text(longer, shorter) + " inner corners, not " +
           size_text(columns, rows) + (fits ? ": another board, or it is cut off" : "");
  return "only " + std::to_string(best.found()) + " of " + std::to_string(columns * rows) +
         " corners found: cut off, covered or blurred";
}

// What is wrong with a picture's light, for the message; empty for nothing.
std::string light_hint(const FloatImage& image) {
  std::size_t white = 0;
  double sum = 0;
  for (const float value : image.pixels()) {
    white += value >= saturated ? 1 : 0;
    sum += static_cast<double>(value);
  }
  const double count = static_cast<double>(image.size().area());
  if (static_cast<double>(white) > overexposed_share * count) return " (over-exposed)";
  if (sum < too_dark * count) return " (too dark)";
  return "";
}

struct Search {
  float blur_px;
  float ring_px;
};
constexpr Search searches[] = {{1.5F, 5}, {3, 8}};

// Corners that are known already, in the reduced picture.
struct Known {
  std::vector<Vector2d> corners;
  double radius = 0;

  [[nodiscard]] bool holds(const Vector2d& at) const {
    return std::ranges::any_of(corners, [&](const Vector2d& known) { return (known - at).norm() < radius; });
  }
};

Known known_corners(const ChessboardCorners& board, int factor) {
  Known known{{}, hide_share * square_px(board) / factor};
  for (const auto& corner : board.corners)
    if (corner) known.corners.emplace_back((*corner - Vector2d::Constant((factor - 1) / 2.0)) / factor);
  return known;
}

// Searches the reduced picture for other corners than the known ones, sharp structures first.
Expected<ChessboardCorners> search(const FloatImage& image, int columns, int rows, const char* what,
                                   const Known& known = {}) {
  std::vector<ChessboardCorners> seen;
  for (const Search& trial : searches) {
    SaddleOptions options;
    options.blur_px = trial.blur_px;
    options.ring_px = trial.ring_px;
    std::vector<SaddlePoint> saddles = find_saddle_points(image, options);
    std::erase_if(saddles, [&](const SaddlePoint& saddle) { return known.holds(saddle.at); });
    const std::vector<ChessboardCorners> boards = grow_chessboards(saddles);
    for (const ChessboardCorners& board : boards) {
      const auto upright = turned_upright(board, columns, rows);
      if (upright && upright->found() >= min_found * columns * rows) return *upright;
    }
    if (seen.empty() || (!boards.empty() && boards.front().found() > seen.front().found())) seen = boards;
  }
  return input_error(std::string(what) + ": " + describe(seen, columns, rows));
}

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

// later / earlier, in grey levels, where there is light to compare.
FloatImage ratio_of(const FloatImage& later, const FloatImage& earlier) {
  FloatImage ratio(later.size());
  for (std::size_t i = 0; i < ratio.size().area(); ++i) {
    const float value = later.data()[i] / std::max(earlier.data()[i], min_light);
    ratio.data()[i] = full_scale / max_ratio * std::min(value, max_ratio);
  }
  return ratio;
}

float median_of(const FloatImage& image) {
  return median(std::vector<float>(image.pixels().begin(), image.pixels().end()));
}

// How much a pixel of the ratio can be trusted: its noise falls with the light it is relative to.
FloatImage trust_in(const FloatImage& earlier) {
  FloatImage trust(earlier.size());
  float brightest = min_light;
  for (const float value : earlier.pixels()) brightest = std::max(brightest, value);
  for (std::size_t i = 0; i < trust.size().area(); ++i)
    trust.data()[i] = std::max(earlier.data()[i], 0.0F) / brightest;
  return trust;
}

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
  const Known known = known_corners(corners, factor);
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

Expected<FoundBoard> find_printed_board(const Luma& picture, const PrintedBoard& board) {
  constexpr const char* what = "printed board";
  const FloatImage image = encoded(picture);
  const int factor = search_factor(image.size());
  const FloatImage small = reduced(image, factor);
  const auto rough = search(small, board.columns, board.rows, what);
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
  const auto on_ratio = search(small_ratio, board.columns, board.rows, what);
  const FloatImage image = encoded(projected);
  if (on_ratio) {
    if (const auto exposed = check_exposure(reduced(image, factor), *on_ratio, what); !exposed)
      return tl::unexpected(exposed.error());
    const FloatImage trust = trust_in(earlier);
    auto found = refined(ratio_of(later, earlier), &trust, enlarged(*on_ratio, factor), what);
    if (found) return found;
  }
  const auto on_picture = search(reduced(image, factor), board.columns, board.rows, what,
                                 known_corners(printed_board.corners, factor));
  if (on_picture) return refined(image, nullptr, enlarged(*on_picture, factor), what);
  const std::string dark =
      median_of(small_ratio) < full_scale / max_ratio * too_little_change ? " (too dark)" : "";
  const std::string hint = dark.empty() ? light_hint(reduced(image, factor)) : dark;
  return input_error((on_ratio ? on_picture.error() : on_ratio.error()).message + hint);
}

std::optional<double> board_shift_px(const Luma& later, const FoundBoard& before) {
  const FloatImage image = encoded(later);
  const auto near_by = small_shift(image, before.corners);
  return near_by ? near_by : large_shift(image, before.corners);
}

}  // namespace bodyscan
