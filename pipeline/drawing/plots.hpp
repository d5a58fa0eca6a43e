#pragma once

#include "pipeline/board/board.hpp"
#include "pipeline/calibration/calibration_report.hpp"
#include "pipeline/geometry/calibration.hpp"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace bodyscan {

// Pictures of how good a calibration is and what it rests on, for people; each is a whole SVG file. A pose
// has the same colour in all of them.

// What is left of every used corner as an arrow in the camera's and the projector's picture.
std::string residual_plot(const CalibrationReport& report, const Calibration& calibration);

// All corners in the camera's and the projector's picture: dots, crosses where they were left out.
std::string coverage_plot(const CalibrationReport& report, const Calibration& calibration);

// Camera, projector and boards in space, isometric; boards that were left out are dashed, and not there where
// no pose is known (not before the camera).
std::string pose_plot(const CalibrationReport& report, const Calibration& calibration,
                      const PrintedBoard& board);

// How many used corners have residuals of which length.
std::string residual_histogram(const CalibrationReport& report);

// The files of all of them.
constexpr std::array<std::string_view, 4> plot_file_names{"residuals.svg", "coverage.svg", "poses.svg",
                                                          "histogram.svg"};

struct Plot {
  std::string_view file_name;
  std::string svg;
};

// All of them, in the order of their names.
std::vector<Plot> calibration_plots(const CalibrationReport& report, const Calibration& calibration,
                                    const PrintedBoard& board);

}  // namespace bodyscan
