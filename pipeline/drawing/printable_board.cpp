#include "pipeline/drawing/printable_board.hpp"

#include "pipeline/base/number_text.hpp"

#include <algorithm>
#include <optional>

namespace bodyscan {
namespace {

using Eigen::Vector2d;

constexpr double least_white = 5;  // around the board, and from the paper's edge to the ruler
constexpr int ruler_length = 100;
constexpr double ruler_depth = 17;  // ticks, numbers and two lines of text
constexpr double strip_depth = ruler_depth + least_white;
constexpr double strip_length = ruler_length + 2 * least_white;
constexpr double tick_width = 0.2;
constexpr double digit_width = 0.556 * page_text_mm;  // Helvetica's metrics

enum class RulerSide { below, right };

struct Layout {
  Vector2d page;
  RulerSide ruler;
  Vector2d board_corner;  // of the black squares, on the page
  double white;
};

Layout layout_of(const Vector2d& board, const Vector2d& page, RulerSide ruler) {
  const Vector2d strip = ruler == RulerSide::below ? Vector2d(0, strip_depth) : Vector2d(strip_depth, 0);
  const Vector2d margins = (page - board - strip) / 2;
  const bool ruler_fits = (ruler == RulerSide::below ? page.x() : page.y()) >= strip_length;
  return {page, ruler, margins, ruler_fits ? margins.minCoeff() : -1};
}

// The one with most white around the board, up to `enough`; nothing that has too little.
std::optional<Layout> best_layout(const Vector2d& board, const Vector2d& paper, double enough) {
  const Vector2d landscape(paper.maxCoeff(), paper.minCoeff());
  const Vector2d portrait(paper.minCoeff(), paper.maxCoeff());
  std::optional<Layout> best;
  for (const RulerSide ruler : {RulerSide::below, RulerSide::right}) {
    for (const Vector2d& page : {landscape, portrait}) {
      const Layout layout = layout_of(board, page, ruler);
      if (layout.white >= least_white - 1e-9 &&
          (!best || std::min(layout.white, enough) > std::min(best->white, enough)))
        best = layout;
    }
  }
  return best;
}

// The ruler's strip: u runs along the ruler as its text reads, v from the ruler's line to the paper's edge.
class RulerStrip {
 public:
  RulerStrip(BoardPage& page, const Layout& layout)
      : page_(page), upwards_(layout.ruler == RulerSide::right) {
    const double length = upwards_ ? layout.page.y() : layout.page.x();
    const double depth = upwards_ ? layout.page.x() : layout.page.y();
    const double board_start = upwards_ ? layout.board_corner.y() : layout.board_corner.x();
    u_ = std::min(board_start, length - ruler_length - least_white);
    v_ = depth - least_white - ruler_depth;
    if (upwards_) u_ = length - u_;
  }

  void add_rectangle(double u, double v, double along, double across) {
    if (upwards_)
      page_.ruler.push_back({{v_ + v, u_ - u - along}, {across, along}});
    else
      page_.ruler.push_back({{u_ + u, v_ + v}, {along, across}});
  }
  void add_text(double u, double v, std::string text) {
    const Vector2d start = upwards_ ? Vector2d(v_ + v, u_ - u) : Vector2d(u_ + u, v_ + v);
    page_.texts.push_back({start, upwards_, std::move(text)});
  }

 private:
  BoardPage& page_;
  bool upwards_;
  double u_;
  double v_;
};

std::string size_text(const Vector2d& size) {
  return short_text(size.x(), 4) + " x " + short_text(size.y(), 4) + " mm";
}

void draw_ruler(RulerStrip& strip, const PrintedBoard& board, const Vector2d& board_size) {
  strip.add_rectangle(-tick_width / 2, 0, ruler_length + tick_width, tick_width);
  for (int mm = 0; mm <= ruler_length; ++mm) {
    strip.add_rectangle(mm - tick_width / 2, 0, tick_width, mm % 10 == 0 ? 5.5 : mm % 5 == 0 ? 4 : 3);
    if (mm % 10 != 0) continue;
    const std::string label = std::to_string(mm);
    strip.add_text(mm - digit_width * static_cast<double>(label.size()) / 2, 8.5, label);
  }
  strip.add_text(0, 12.5, "measure this ruler: " + std::to_string(ruler_length) + " mm");
  strip.add_text(0, 16,
                 std::to_string(board.columns) + " x " + std::to_string(board.rows) +
                     " inner corners, squares of " + short_text(board.square_mm, 4) + " mm, board " +
                     size_text(board_size));
}

}  // namespace

Expected<BoardPage> printable_board(const PrintedBoard& board, const Vector2d& paper_mm) {
  const Vector2d size = board.square_mm * Vector2d(board.columns + 1, board.rows + 1);
  const std::optional<Layout> layout = best_layout(size, paper_mm, board.square_mm);
  if (!layout) {
    const Vector2d around = size + Vector2d::Constant(2 * least_white);
    const Vector2d ruler_below(std::max(around.x(), strip_length), around.y() + strip_depth);
    const Vector2d ruler_right(around.x() + strip_depth, std::max(around.y(), strip_length));
    return tl::unexpected(
        Error{ErrorKind::usage, "a board of " + size_text(size) + " and its ruler need paper of " +
                                    size_text(ruler_below) + " or " + size_text(ruler_right) + ", not " +
                                    size_text(paper_mm)});
  }
  BoardPage page;
  page.size_mm = layout->page;
  page.white_mm = layout->white;
  for (int row = 0; row <= board.rows; ++row) {
    for (int column = row % 2; column <= board.columns; column += 2)
      page.squares.push_back({layout->board_corner + board.square_mm * Vector2d(column, row),
                              Vector2d::Constant(board.square_mm)});
  }
  RulerStrip strip(page, *layout);
  draw_ruler(strip, board, size);
  return page;
}

}  // namespace bodyscan
