#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/decode/correspondence.hpp"
#include "pipeline/geometry/calibration.hpp"
#include "pipeline/geometry/point_grid.hpp"

namespace bodyscan {

struct TriangulateOptions {
  float max_sigma_mm = 0.4F;    // a point whose depth is less certain is left out
  float max_disagreement = 4;   // rows against columns, in standard deviations of their difference
  float calibration_px = 0.3F;  // projector px: what the calibration adds to that deviation

  [[nodiscard]] Expected<void> check() const;
};

// The depth at which each pixel's camera ray meets the measured projector row or column, the projector's
// distortion included (a projected row is a curve in space, not a plane): Newton's method on depth from the
// solution without distortion. Rows and columns, where both were measured, are met in least squares, each
// weighted with its uncertainty. Input error: the correspondence's sizes are not the calibration's.
Expected<PointGrid> triangulate(const Correspondence& correspondence, const Calibration& calibration,
                                const TriangulateOptions& options = {});

}  // namespace bodyscan
