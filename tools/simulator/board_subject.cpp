#include "tools/simulator/shapes.hpp"
#include "tools/simulator/subjects.hpp"

namespace bodyscan::simulator {

using Eigen::Vector2d;
using Eigen::Vector3d;

Subject make_printed_board(const PrintedSheet& sheet) {
  constexpr double step_mm = 1;  // of a bent sheet: 0.0003 mm off a circle of 400 mm
  Subject subject{
      .name = "printed board", .mesh = {}, .facts = {}, .material = Material::printed, .sheet = sheet};
  const Vector2d first = sheet.middle() - sheet.half_plate();
  const Vector2d last = sheet.middle() + sheet.half_plate();
  if (sheet.is_flat()) {
    append_rectangle(subject.mesh, sheet.point(sheet.middle()), sheet.half_plate().x() * Vector3d::UnitX(),
                     sheet.half_plate().y() * Vector3d::UnitY());
  } else {
    append_surface(subject.mesh,
                   [&](double u, double v) {
                     return sheet.point({u, v});
                   },
                   even_steps(first.x(), last.x(), step_mm), {first.y(), last.y()});
  }
  return subject;
}

}  // namespace bodyscan::simulator
