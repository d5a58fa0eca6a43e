#pragma once

#include "pipeline/calibration/bundle_adjustment.hpp"

#include <optional>
#include <vector>

namespace bodyscan {

// The printed corners of one pose, triangulated: what a calibration is worth, and no reprojection error.
struct TriangulatedBoard {
  std::vector<double> sides;  // of neighbouring corners' distances, over the printed square's side
  double plane_rms_mm = 0;
};

// Corners that both devices see. Where beams tell the projector's view, a homography between ideal image
// coordinates carries the printed corners over.
TriangulatedBoard triangulate_board(const Calibration& calibration, const PrintedBoard& board,
                                    const PoseObservation& pose);

// Mean less one and standard deviation of sides, in percent; nothing of none.
struct SideFigures {
  std::optional<double> error_percent;
  std::optional<double> spread_percent;
};
SideFigures figures_of(const std::vector<double>& sides);

}  // namespace bodyscan
