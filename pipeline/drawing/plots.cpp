#include "pipeline/drawing/plots.hpp"

namespace bodyscan {

std::vector<Plot> calibration_plots(const CalibrationReport& report, const Calibration& calibration,
                                    const PrintedBoard& board) {
  return {{"residuals.svg", residual_plot(report, calibration)},
          {"coverage.svg", coverage_plot(report, calibration)},
          {"poses.svg", pose_plot(report, calibration, board)},
          {"histogram.svg", residual_histogram(report)}};
}

}  // namespace bodyscan
