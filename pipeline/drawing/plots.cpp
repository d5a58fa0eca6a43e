#include "pipeline/drawing/plots.hpp"

namespace bodyscan {

std::vector<Plot> calibration_plots(const CalibrationReport& report, const Calibration& calibration,
                                    const PrintedBoard& board) {
  return {{plot_file_names[0], residual_plot(report, calibration)},
          {plot_file_names[1], coverage_plot(report, calibration)},
          {plot_file_names[2], pose_plot(report, calibration, board)},
          {plot_file_names[3], residual_histogram(report)}};
}

}  // namespace bodyscan
