#include "pipeline/board/chessboard.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace bodyscan {
namespace {

using Eigen::Vector2d;

constexpr double max_deviation = 0.3;    // of a step, from where a corner is expected
constexpr double max_first_angle = 0.4;  // rad, of the first neighbour from the seed's edge
constexpr double max_edge_angle = 0.45;  // rad, between neighbours' edges
constexpr int min_corners = 9;

using Place = std::pair<int, int>;  // column, row; may be negative while a board grows

double angle_between_lines(const Vector2d& a, const Vector2d& b) {
  return std::acos(std::min(1.0, std::abs(a.dot(b))));
}

// Squares to find points near a place quickly.
class PointIndex {
 public:
  explicit PointIndex(std::span<const SaddlePoint> points) : points_(points) {
    for (std::size_t i = 0; i < points.size(); ++i) cells_[cell_of(points[i].at)].push_back(i);
  }

  // Calls visit(index, distance) for the points within `radius` of a place.
  template <class Visit>
  void near(const Vector2d& at, double radius, Visit visit) const {
    const auto [left, top] = cell_of(at - Vector2d::Constant(radius));
    const auto [right, bottom] = cell_of(at + Vector2d::Constant(radius));
    for (int y = top; y <= bottom; ++y) {
      for (int x = left; x <= right; ++x) {
        const auto cell = cells_.find({x, y});
        if (cell == cells_.end()) continue;
        for (const std::size_t i : cell->second) {
          const double distance = (points_[i].at - at).norm();
          if (distance <= radius) visit(i, distance);
        }
      }
    }
  }

 private:
  static constexpr double cell_px = 32;
  static Place cell_of(const Vector2d& at) {
    return {static_cast<int>(std::floor(at.x() / cell_px)), static_cast<int>(std::floor(at.y() / cell_px))};
  }
  std::span<const SaddlePoint> points_;
  std::map<Place, std::vector<std::size_t>> cells_;
};

class Grower {
 public:
  explicit Grower(std::span<const SaddlePoint> points)
      : points_(points), index_(points), taken_(points.size(), false), on_board_(points.size(), false) {}

  // The board around a seed; empty where it does not even have four neighbours in a square.
  std::map<Place, std::size_t> grow(std::size_t seed) {
    for (const auto& [place, point] : board_) on_board_[point] = false;
    board_.clear();
    to_try_.clear();
    const SaddlePoint& first = points_[seed];
    const auto right = first_neighbour(seed, first.edges[0]);
    const auto down = first_neighbour(seed, first.edges[1]);
    if (!right || !down) return {};
    put({0, 0}, seed);
    put({1, 0}, *right);
    const Vector2d along = points_[*right].at - first.at;
    const Vector2d across = points_[*down].at - first.at;
    const bool right_handed = along.x() * across.y() > along.y() * across.x();
    put({0, right_handed ? 1 : -1}, *down);
    while (add_ring()) {
    }
    return board_;
  }

  void take(const std::map<Place, std::size_t>& board) {
    for (const auto& [place, point] : board) taken_[point] = true;
  }
  [[nodiscard]] bool taken(std::size_t point) const { return taken_[point]; }

 private:
  [[nodiscard]] bool changes_colour(std::size_t a, std::size_t b) const {
    const SaddlePoint& one = points_[a];
    const SaddlePoint& other = points_[b];
    const bool straight =
        angle_between_lines(one.edges[0], other.edges[0]) +
            angle_between_lines(one.edges[1], other.edges[1]) <
        angle_between_lines(one.edges[0], other.edges[1]) + angle_between_lines(one.edges[1], other.edges[0]);
    const double turned = straight ? std::max(angle_between_lines(one.edges[0], other.edges[0]),
                                              angle_between_lines(one.edges[1], other.edges[1]))
                                   : std::max(angle_between_lines(one.edges[0], other.edges[1]),
                                              angle_between_lines(one.edges[1], other.edges[0]));
    if (turned > max_edge_angle) return false;
    return one.positive != bright_between_edges_of(one, other);
  }

  // Whether `point` is bright where `reference` has the sector between its edges.
  [[nodiscard]] static bool bright_between_edges_of(const SaddlePoint& reference, const SaddlePoint& point) {
    const Vector2d between = (reference.edges[0] + reference.edges[1]).normalized();
    const Vector2d beside = (reference.edges[0] - reference.edges[1]).normalized();
    const Vector2d bright = (point.edges[0] + (point.positive ? 1.0 : -1.0) * point.edges[1]).normalized();
    return std::abs(bright.dot(between)) > std::abs(bright.dot(beside));
  }

  [[nodiscard]] std::optional<std::size_t> first_neighbour(std::size_t from, const Vector2d& edge) const {
    std::optional<std::size_t> nearest;
    double best = std::numeric_limits<double>::max();
    for (double radius = 40; radius <= 640 && !nearest; radius *= 2) {
      index_.near(points_[from].at, radius, [&](std::size_t i, double distance) {
        if (i == from || taken_[i] || distance >= best) return;
        const Vector2d direction = (points_[i].at - points_[from].at) / distance;
        if (angle_between_lines(direction, edge) > max_first_angle / 2 || !changes_colour(from, i)) return;
        best = distance;
        nearest = i;
      });
    }
    return nearest;
  }

  [[nodiscard]] std::optional<Vector2d> at(int column, int row) const {
    const auto found = board_.find({column, row});
    if (found == board_.end()) return std::nullopt;
    return points_[found->second].at;
  }

  struct Expected {
    Vector2d at;
    double step;       // px to the neighbour it follows from
    std::size_t from;  // that neighbour
  };

  // Where the corner at a free place should be: straight on from two neighbours, or parallel to the step
  // beside it.
  [[nodiscard]] std::optional<Expected> expected(const Place& place) const {
    constexpr std::array<Place, 4> directions{Place{1, 0}, Place{-1, 0}, Place{0, 1}, Place{0, -1}};
    Vector2d sum = Vector2d::Zero();
    double weight = 0;
    double step = 0;
    std::size_t from = 0;
    for (const auto& [dx, dy] : directions) {
      const auto one = at(place.first - dx, place.second - dy);
      if (!one) continue;
      if (const auto two = at(place.first - 2 * dx, place.second - 2 * dy)) {
        const auto three = at(place.first - 3 * dx, place.second - 3 * dy);
        // The step goes on changing as it did: perspective.
        const Vector2d change = three ? Vector2d(*one - 2 * *two + *three) : Vector2d(Vector2d::Zero());
        sum += 2 * (2 * *one - *two + change);
        weight += 2;
      } else {
        std::optional<Vector2d> beside;
        for (const int side : {1, -1}) {
          const auto corner = at(place.first - dx + side * dy, place.second - dy + side * dx);
          const auto across = at(place.first + side * dy, place.second + side * dx);
          if (corner && across) beside = *across - *corner;
        }
        if (!beside) continue;
        sum += *one + *beside;
        weight += 1;
      }
      from = board_.at({place.first - dx, place.second - dy});
      step = (sum / weight - *one).norm();
    }
    if (weight == 0) return std::nullopt;
    return Expected{sum / weight, step, from};
  }

  void put(const Place& place, std::size_t point) {
    board_[place] = point;
    on_board_[point] = true;
    // The places whose `expected` depends on this one.
    const auto [column, row] = place;
    for (const int side : {-1, 1}) {
      for (const int steps : {1, 2, 3}) {
        to_try_.emplace(column + side * steps, row);
        to_try_.emplace(column, row + side * steps);
      }
      to_try_.emplace(column + side, row - 1);
      to_try_.emplace(column + side, row + 1);
    }
  }

  // Every free place where a corner may be expected now and was not before; whether any was added.
  bool add_ring() {
    std::map<Place, std::size_t> found;
    std::map<std::size_t, int> uses;
    for (const Place& place : std::exchange(to_try_, {})) {
      if (board_.contains(place)) continue;
      const auto where = expected(place);
      const auto corner = where ? corner_near(*where) : std::nullopt;
      if (!corner || on_board_[*corner]) continue;
      found[place] = *corner;
      ++uses[*corner];
    }
    bool added = false;
    for (const auto& [place, corner] : found) {
      if (uses[corner] > 1) {
        to_try_.insert(place);
        continue;
      }
      put(place, corner);
      added = true;
    }
    return added;
  }

  [[nodiscard]] std::optional<std::size_t> corner_near(const Expected& where) const {
    std::optional<std::size_t> nearest;
    double best = max_deviation * where.step;
    index_.near(where.at, best, [&](std::size_t i, double distance) {
      if (taken_[i] || distance > best || !changes_colour(where.from, i)) return;
      best = distance;
      nearest = i;
    });
    return nearest;
  }

  std::span<const SaddlePoint> points_;
  PointIndex index_;
  std::vector<bool> taken_;
  std::map<Place, std::size_t> board_;
  std::vector<bool> on_board_;  // by point
  std::set<Place> to_try_;
};

struct Extent {
  int left = std::numeric_limits<int>::max();
  int right = std::numeric_limits<int>::min();
  int top = std::numeric_limits<int>::max();
  int bottom = std::numeric_limits<int>::min();
};

Extent extent_of(const std::map<Place, std::size_t>& board) {
  Extent extent;
  for (const auto& [place, point] : board) {
    extent.left = std::min(extent.left, place.first);
    extent.right = std::max(extent.right, place.first);
    extent.top = std::min(extent.top, place.second);
    extent.bottom = std::max(extent.bottom, place.second);
  }
  return extent;
}

// Rows and columns at the rim that hold less than a third of their corners are stray saddles, not the board.
void trim(std::map<Place, std::size_t>& board) {
  while (!board.empty()) {
    const Extent extent = extent_of(board);
    const int columns = extent.right - extent.left + 1;
    const int rows = extent.bottom - extent.top + 1;
    const auto sparse = [&](bool column, int index, int length) {
      const auto count = std::ranges::count_if(board, [&](const auto& entry) {
        return (column ? entry.first.first : entry.first.second) == index;
      });
      return 3 * count < length;
    };
    const auto erase = [&](bool column, int index) {
      std::erase_if(board, [&](const auto& entry) {
        return (column ? entry.first.first : entry.first.second) == index;
      });
    };
    if (sparse(true, extent.left, rows)) {
      erase(true, extent.left);
    } else if (sparse(true, extent.right, rows)) {
      erase(true, extent.right);
    } else if (sparse(false, extent.top, columns)) {
      erase(false, extent.top);
    } else if (sparse(false, extent.bottom, columns)) {
      erase(false, extent.bottom);
    } else {
      return;
    }
  }
}

ChessboardCorners ordered(const std::map<Place, std::size_t>& board, std::span<const SaddlePoint> points) {
  const Extent extent = extent_of(board);
  ChessboardCorners corners{extent.right - extent.left + 1, extent.bottom - extent.top + 1, {}};
  corners.corners.resize(static_cast<std::size_t>(corners.columns * corners.rows));
  for (const auto& [place, point] : board)
    corners.corners[static_cast<std::size_t>((place.second - extent.top) * corners.columns + place.first -
                                             extent.left)] = points[point].at;
  return corners;
}

// Columns become rows, counted the other way: the board stays right-handed.
ChessboardCorners turned_by_a_quarter(const ChessboardCorners& board) {
  ChessboardCorners turned{board.rows, board.columns, {}};
  for (int row = 0; row < turned.rows; ++row)
    for (int column = 0; column < turned.columns; ++column)
      turned.corners.push_back(board.at(board.columns - 1 - row, column));
  return turned;
}

Vector2d column_direction(const ChessboardCorners& board) {
  Vector2d sum = Vector2d::Zero();
  for (int row = 0; row < board.rows; ++row)
    for (int column = 0; column + 1 < board.columns; ++column)
      if (board.at(column, row) && board.at(column + 1, row))
        sum += *board.at(column + 1, row) - *board.at(column, row);
  return sum.normalized();
}

}  // namespace

int ChessboardCorners::found() const {
  return static_cast<int>(
      std::ranges::count_if(corners, [](const auto& corner) { return corner.has_value(); }));
}

std::optional<ChessboardCorners> turned_upright(const ChessboardCorners& board, int columns, int rows) {
  // A square board fits four ways, an eighth of a turn from this direction to the next; others fit two.
  const Vector2d wanted = columns == rows ? Vector2d(1, 0) : Vector2d(1, 1);
  std::optional<ChessboardCorners> best;
  double best_direction = -std::numeric_limits<double>::max();
  ChessboardCorners turned = board;
  for (int quarter = 0; quarter < 4; ++quarter, turned = turned_by_a_quarter(turned)) {
    if (turned.columns != columns || turned.rows != rows) continue;
    const double direction = column_direction(turned).dot(wanted);
    if (direction <= best_direction) continue;
    best_direction = direction;
    best = turned;
  }
  return best;
}

std::vector<ChessboardCorners> grow_chessboards(std::span<const SaddlePoint> saddles) {
  std::vector<std::size_t> seeds(saddles.size());
  std::iota(seeds.begin(), seeds.end(), std::size_t{0});
  std::ranges::stable_sort(
      seeds, [&](std::size_t a, std::size_t b) { return saddles[a].strength > saddles[b].strength; });
  Grower grower(saddles);
  std::vector<ChessboardCorners> boards;
  for (const std::size_t seed : seeds) {
    if (grower.taken(seed)) continue;
    std::map<Place, std::size_t> board = grower.grow(seed);
    trim(board);
    if (static_cast<int>(board.size()) < min_corners) continue;
    grower.take(board);
    boards.push_back(ordered(board, saddles));
  }
  std::ranges::stable_sort(boards, [](const auto& a, const auto& b) { return a.found() > b.found(); });
  return boards;
}

}  // namespace bodyscan
