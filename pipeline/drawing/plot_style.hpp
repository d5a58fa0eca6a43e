#pragma once

#include "pipeline/base/image.hpp"
#include "pipeline/calibration/calibration_report.hpp"
#include "pipeline/drawing/svg_picture.hpp"
#include "pipeline/geometry/calibration.hpp"

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace bodyscan {

// What a calibration's plots look like. Lengths are pixels of the plot.
constexpr double plot_margin = 24;
constexpr double plot_head = 70;  // above the drawing: title and a line below it
constexpr double label_size = 13;
constexpr std::string_view plot_ink = "#333";

// The largest of 1, 2, 5, 10, ... times a power of ten that is not above `limit` > 0.
double round_length(double limit);

// `fill="#1f77b4"` for name "fill"; the colour of a report's pose `index`.
std::string colored(std::string_view name, std::size_t index);

// `name="value"`.
std::string styled(std::string_view name, std::string_view value);

// A white sheet with title and the line below it.
SvgPicture plot_sheet(double width, double height, const std::string& title, const std::string& subtitle);

// The poses' names beside a drawing, in as many columns as its height needs.
class PoseLegend {
 public:
  PoseLegend(const std::vector<PoseReport>& poses, double height);
  [[nodiscard]] double width() const;
  void draw(SvgPicture& sheet, const Eigen::Vector2d& corner) const;

 private:
  const std::vector<PoseReport>& poses_;
  std::size_t rows_;
};

// Where a camera's or projector's picture lies on the sheet.
struct PictureFrame {
  Eigen::Vector2d corner;
  double scale;  // sheet by picture
  Size picture;

  [[nodiscard]] Eigen::Vector2d size() const {
    return scale * Eigen::Vector2d(picture.width, picture.height);
  }
  // Of a position in the picture, pixel centres at integers.
  [[nodiscard]] Eigen::Vector2d at(const Eigen::Vector2d& pixel) const {
    return corner + scale * (pixel + Eigen::Vector2d::Constant(0.5));
  }
  void draw(SvgPicture& sheet) const;
};

// The camera's and the projector's picture side by side, equally high, the poses' names beside them.
struct PicturePair {
  PicturePair(const Calibration& calibration, double height);
  // The sheet with both frames; `below` them is room.
  [[nodiscard]] SvgPicture sheet(const std::vector<PoseReport>& poses, double below, const std::string& title,
                                 const std::string& subtitle) const;

  PictureFrame camera;
  PictureFrame projector;
};

// "Camera, 4288 x 2848 pixels: 186 corners", below its frame.
void draw_caption(SvgPicture& sheet, const PictureFrame& frame, const std::string& device,
                  const std::string& content);

// The root of the mean square; zero of none.
double rms_of(const std::vector<double>& values);

// The lengths of the used corners' residuals, of the poses that were used.
std::vector<double> residual_lengths(const CalibrationReport& report,
                                     std::vector<CornerResidual> PoseReport::*device);

}  // namespace bodyscan
