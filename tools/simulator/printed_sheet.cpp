#include "tools/simulator/printed_sheet.hpp"

#include "tools/simulator/skin.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bodyscan::simulator {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr float ink_albedo = 0.06F;
constexpr float paper_albedo = matt_albedo;
constexpr float plate_albedo = 0.7F;
constexpr double farthest_plate_radians = 1;  // a plate does not close to a tube

// Of the circle whose arc of `length` rises `height` over its chord.
double curvature_of(double length, double height) {
  double smallest = 0;
  double largest = std::numbers::pi / 2;  // half the arc's angle
  const double wanted = std::abs(height) / length;
  for (int step = 0; step < 60; ++step) {
    const double half = (smallest + largest) / 2;
    ((1 - std::cos(half)) / (2 * half) < wanted ? smallest : largest) = half;
  }
  return std::copysign(2 * largest / length, height);
}

// Rises from 0 to 1 over `width` around 0.
double ramp(double distance, double width) {
  if (width <= 0) return distance < 0 ? 0 : 1;
  return std::clamp(distance / width + 0.5, 0.0, 1.0);
}

// +1 and -1 by turns between edges at the whole numbers 0 to `corners` - 1; -1 before the first.
double turns(double at, int corners, double width) {
  const double edge = std::clamp(std::round(at), 0.0, corners - 1.0);
  const double side = 2 * ramp(at - edge, width) - 1;
  return static_cast<int>(edge) % 2 == 0 ? side : -side;
}

// 1 inside a rectangle around `middle`, 0 outside.
double cover(const Vector2d& at, const Vector2d& middle, const Vector2d& half, double width) {
  const Vector2d inside = half - (at - middle).cwiseAbs();
  return ramp(inside.x(), width) * ramp(inside.y(), width);
}

}  // namespace

PrintedSheet::PrintedSheet(const PrintedBoard& board, const SheetForm& form)
    : board_(board),
      form_(form),
      middle_(board.square_mm / 2 * Vector2d(board.columns - 1, board.rows - 1)),
      half_sheet_(board.square_mm / 2 * Vector2d(board.columns + 3, board.rows + 3)),
      half_plate_(half_sheet_.array() + form.plate_mm) {
  if (form.bend_mm == 0) return;
  curvature_ = curvature_of(2 * half_sheet_.x(), form.bend_mm);
  half_plate_.x() =
      std::max(half_sheet_.x(), std::min(half_plate_.x(), farthest_plate_radians / std::abs(curvature_)));
}

Vector3d PrintedSheet::point(const Vector2d& paper) const {
  if (is_flat()) return {paper.x(), paper.y(), 0};
  const double angle = (paper.x() - middle_.x()) * curvature_;
  const double half_sine = std::sin(angle / 2);
  return {middle_.x() + std::sin(angle) / curvature_, paper.y(), 2 * half_sine * half_sine / curvature_};
}

Vector2d PrintedSheet::paper(const Vector3d& point) const {
  if (is_flat()) return point.head<2>();
  const double sine = std::clamp((point.x() - middle_.x()) * curvature_, -1.0, 1.0);
  return {middle_.x() + std::asin(sine) / curvature_, point.y()};
}

std::optional<Vector2d> PrintedSheet::hit(const Vector3d& origin, const Vector3d& direction) const {
  double along = -origin.z() / direction.z();
  for (int step = 0; step < 20 && !is_flat(); ++step) {  // Newton on the depth behind the paper
    const Vector3d at = origin + along * direction;
    const double sine = (at.x() - middle_.x()) * curvature_;
    if (!(std::abs(sine) < 0.99)) return std::nullopt;
    const double cosine = std::sqrt(1 - sine * sine);
    const double behind = at.z() - sine * sine / (1 + cosine) / curvature_;
    along -= behind / (direction.z() - sine / cosine * direction.x());
  }
  const Vector2d at = paper(origin + along * direction);
  if (!(along > 0) || !(((at - middle_).cwiseAbs().array() <= half_plate_.array()).all()))
    return std::nullopt;
  return at;
}

float PrintedSheet::albedo(const Vector2d& paper) const {
  const double edge = form_.edge_mm;
  const Vector2d squares = half_sheet_.array() - board_.square_mm;
  const double sides = turns(paper.x() / board_.square_mm, board_.columns, edge / board_.square_mm) *
                       turns(paper.y() / board_.square_mm, board_.rows, edge / board_.square_mm);
  const double ink = cover(paper, middle_, squares, edge) * (1 + sides) / 2;
  const auto printed = paper_albedo + static_cast<float>(ink) * (ink_albedo - paper_albedo);
  return plate_albedo +
         static_cast<float>(cover(paper, middle_, half_sheet_, edge)) * (printed - plate_albedo);
}

}  // namespace bodyscan::simulator
