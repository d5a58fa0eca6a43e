#pragma once

#include "pipeline/image/srgb.hpp"
#include "tools/simulator/session_folder.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

namespace bodyscan::simulator {

// Pictures of 429 x 285 pixels and a projector of 256 x 192, without noise.
inline SessionOptions small_session(SessionMethod method) {
  SessionOptions options;
  options.render.calibration = "builtin:diagonal";
  options.render.rig.scale = 0.1;
  options.render.rig.projector = {256, 192};
  options.render.full_well = 0;
  options.render.format = FrameFormat::png;
  options.method = method;
  return options;
}

// Room light alone, which is even.
inline RenderOptions even_light(RenderOptions options) {
  options.light = 0;
  options.ambient = 0.5;
  return options;
}

// Of full scale.
inline double green_light(const ColorImage8& image, int x, int y) {
  return srgb_to_linear(image(x, y)[1] / 255.0);
}

// How far a chessboard's edges in a picture lie from where they should be; infinite where there is none, or
// one with its colours exchanged. `light(x, y)` is the picture, evenly lit; `pixel(column, row)` where it
// should show a place of the board, in squares from corner (0, 0).
template <class Light, class Pixel>
double largest_edge_error(int columns, int rows, const Light& light, const Pixel& pixel) {
  constexpr int reach = 4;  // px
  double largest = 0;
  const auto look = [&](double column, double row, bool upright, bool rises) {
    const Eigen::Vector2d on_edge = pixel(column, row);
    const Eigen::Vector2d along =
        upright ? pixel(column, row + 0.1) - on_edge : pixel(column + 0.1, row) - on_edge;
    const int axis = upright ? 0 : 1;  // that the edge is looked for along
    const double line = std::round(on_edge[1 - axis]);
    const double wanted = on_edge[axis] + along[axis] / along[1 - axis] * (line - on_edge[1 - axis]);
    const auto at = [&](int i) {
      return upright ? light(i, static_cast<int>(line)) : light(static_cast<int>(line), i);
    };
    const int middle = static_cast<int>(std::lround(wanted));
    double steps = 0;
    double moment = 0;
    for (int i = middle - reach; i < middle + reach; ++i) {
      const double step = at(i + 1) - at(i);
      steps += step;
      moment += step * (i + 0.5 - wanted);
    }
    if (!((rises ? steps : -steps) > 0.2)) largest = INFINITY;
    largest = std::max(largest, std::abs(moment / steps));
  };
  for (int row = 0; row <= rows; ++row) {
    for (int column = 0; column < columns; ++column) look(column, row - 0.5, true, (column + row) % 2 == 0);
  }
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column <= columns; ++column) look(column - 0.5, row, false, (column + row) % 2 == 0);
  }
  return largest;
}

// Of a printed board in even light.
inline double largest_edge_error(const ColorImage8& image, const Lens& camera, const PrintedSheet& sheet,
                                 const RigidTransform& camera_from_board) {
  return largest_edge_error(
      sheet.board().columns, sheet.board().rows, [&](int x, int y) { return green_light(image, x, y); },
      [&](double column, double row) {
        const Eigen::Vector2d paper = sheet.board().square_mm * Eigen::Vector2d(column, row);
        return camera.project(camera_from_board * sheet.point(paper));
      });
}

// Where the camera sees a printed corner.
inline Eigen::Vector2d corner_pixel(const Lens& camera, const PrintedSheet& sheet,
                                    const RigidTransform& camera_from_board, int corner) {
  return camera.project(camera_from_board * sheet.point(sheet.board().corner_mm(corner)));
}

}  // namespace bodyscan::simulator
