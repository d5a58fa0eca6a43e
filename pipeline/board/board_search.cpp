#include "pipeline/board/board_search.hpp"

#include "pipeline/base/size_text.hpp"
#include "pipeline/board/corner_refinement.hpp"
#include "pipeline/board/saddle_points.hpp"

#include <algorithm>
#include <optional>

namespace bodyscan {
namespace {

using Eigen::Vector2d;

constexpr int search_px = 1300;     // longer side of the picture that boards are searched in
constexpr double hide_share = 0.2;  // of a square around a known corner
constexpr double nearly_all = 0.7;  // of the corners wanted: the board itself, cut off

struct Search {
  float blur_px;
  float ring_px;
};
constexpr Search searches[] = {{1.5F, 5}, {3, 8}};

// What a search came upon that is not the board asked for, for the message.
std::string describe(const std::vector<ChessboardCorners>& boards, int columns, int rows) {
  if (boards.empty()) return "no chessboard to be seen";
  const ChessboardCorners& best = boards.front();
  const int longer = std::max(best.columns, best.rows);
  const int shorter = std::min(best.columns, best.rows);
  const bool fits = longer <= std::max(columns, rows) && shorter <= std::min(columns, rows);
  const int wanted = columns * rows;
  if (best.complete() && (!fits || best.found() >= nearly_all * wanted))
    return "the board seen has " + text_of(Size{longer, shorter}) + " inner corners, not " +
           text_of(Size{columns, rows}) + (fits ? ": another board, or it is cut off" : "");
  if (!fits && best.found() >= min_found * wanted)
    return "the board seen has at least " + text_of(Size{longer, shorter}) + " inner corners, not " +
           text_of(Size{columns, rows});
  return "only " + std::to_string(best.found()) + " of " + std::to_string(wanted) +
         " corners found: cut off, covered or blurred";
}

}  // namespace

int search_factor(Size whole) {
  return std::max(1, (std::max(whole.width, whole.height) + search_px - 1) / search_px);
}

ChessboardCorners enlarged(ChessboardCorners board, int factor) {
  for (auto& corner : board.corners)
    if (corner) *corner = factor * *corner + Vector2d::Constant((factor - 1) / 2.0);
  return board;
}

bool KnownCorners::holds(const Vector2d& at) const {
  return std::ranges::any_of(corners, [&](const Vector2d& known) { return (known - at).norm() < radius; });
}

KnownCorners known_corners(const ChessboardCorners& board, int factor) {
  KnownCorners known{{}, hide_share * square_px(board) / factor};
  for (const auto& corner : board.corners)
    if (corner) known.corners.emplace_back((*corner - Vector2d::Constant((factor - 1) / 2.0)) / factor);
  return known;
}

Expected<ChessboardCorners> search_board(const FloatImage& image, int columns, int rows,
                                         const std::string& what, const KnownCorners& known) {
  std::vector<ChessboardCorners> seen;
  // Sharp structures first.
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
  return input_error(what + ": " + describe(seen, columns, rows));
}

}  // namespace bodyscan
