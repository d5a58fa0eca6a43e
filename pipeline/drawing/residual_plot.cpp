#include "pipeline/base/number_text.hpp"
#include "pipeline/base/size_text.hpp"
#include "pipeline/drawing/plot_style.hpp"
#include "pipeline/drawing/plots.hpp"

#include <algorithm>

namespace bodyscan {
namespace {

using Eigen::Vector2d;

constexpr double picture_width = 960;
constexpr double usual_arrow = 36;  // that long is the arrow that 95 % of the others do not exceed
constexpr double longest_key = 80;
constexpr double key_height = 44;  // below the picture: the scale arrow

// How many times longer arrows are than residuals on a picture of that scale: a round number.
double magnification(std::vector<double> lengths, double picture_scale) {
  if (lengths.empty()) return 1;
  const auto nth = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() * 95 / 100);
  std::nth_element(lengths.begin(), nth, lengths.end());
  return *nth > 0 ? round_length(usual_arrow / (*nth * picture_scale)) : 1;
}

void draw_arrow(SvgPicture& sheet, const Vector2d& from, const Vector2d& by, std::size_t color) {
  sheet.line(from, from + by, R"(class="arrow" stroke-width="1.3" )" + colored("stroke", color));
  const double length = by.norm();
  if (!(length > 0)) return;
  const double head = std::min(6.0, 0.5 * length);
  const Vector2d along = by / length;
  const Vector2d across = 0.4 * head * Vector2d(-along.y(), along.x());
  const Vector2d tip = from + by;
  const Vector2d back = tip - head * along;
  const Vector2d corners[] = {tip, back + across, back - across};
  sheet.polygon(corners, colored("fill", color));
}

void draw_key(SvgPicture& sheet, const Vector2d& place, double scale, double times) {
  const double length = round_length(longest_key / scale);
  const std::string label =
      short_text(length, 9) + " px (measured minus predicted, " + short_text(times, 4) + " times enlarged)";
  const Vector2d tip = place + Vector2d(scale * length, 0);
  const Vector2d head[] = {tip, tip + Vector2d(-6, -2.4), tip + Vector2d(-6, 2.4)};
  sheet.line(place, tip, R"(class="key" stroke-width="1.3" )" + styled("stroke", plot_ink));
  sheet.polygon(head, styled("fill", plot_ink));
  sheet.text(tip + Vector2d(12, 4.5), label_size, label, styled("fill", plot_ink));
}

}  // namespace

std::string residual_plot(const CalibrationReport& report, const Calibration& calibration) {
  const std::vector<double> lengths = residual_lengths(report, &PoseReport::camera);
  const Size picture = calibration.camera.size;
  const PictureFrame frame{{plot_margin, plot_head}, picture_width / picture.width, picture};
  const PoseLegend legend(report.poses, frame.size().y());
  const double below = plot_head + frame.size().y();
  SvgPicture sheet =
      plot_sheet(picture_width + 3 * plot_margin + legend.width(), below + key_height + plot_margin / 2,
                 "Residuals in the camera's picture",
                 std::to_string(lengths.size()) + " corners, " + short_text(report.camera_rms_px, 3) +
                     " px RMS; picture of " + text_of(picture) + " pixels");
  frame.draw(sheet);
  legend.draw(sheet, {picture_width + 2 * plot_margin, plot_head});
  const double times = magnification(lengths, frame.scale);
  const double scale = times * frame.scale;  // sheet pixels by residual pixel
  for (std::size_t i = 0; i < report.poses.size(); ++i) {
    if (!report.poses[i].used) continue;
    for (const CornerResidual& corner : report.poses[i].camera)
      if (corner.used) draw_arrow(sheet, frame.at(corner.at), scale * corner.error, i);
  }
  draw_key(sheet, {plot_margin, below + key_height / 2}, scale, times);
  return sheet.finish();
}

}  // namespace bodyscan
