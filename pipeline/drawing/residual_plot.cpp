#include "pipeline/base/number_text.hpp"
#include "pipeline/drawing/plot_style.hpp"
#include "pipeline/drawing/plots.hpp"

#include <algorithm>

namespace bodyscan {
namespace {

using Eigen::Vector2d;

constexpr double picture_height = 480;
constexpr double usual_arrow = 36;  // that long is the arrow that 95 % of the others do not exceed
constexpr double longest_key = 80;
constexpr double key_below = 42;  // a picture: the scale arrow
constexpr double room_below = 60;

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
  const std::string label = short_text(length, 9) + " px, " + short_text(times, 4) + " times enlarged";
  const Vector2d tip = place + Vector2d(scale * length, 0);
  const Vector2d head[] = {tip, tip + Vector2d(-6, -2.4), tip + Vector2d(-6, 2.4)};
  sheet.line(place, tip, R"(class="key" stroke-width="1.3" )" + styled("stroke", plot_ink));
  sheet.polygon(head, styled("fill", plot_ink));
  sheet.text(tip + Vector2d(12, 4.5), label_size, label, styled("fill", plot_ink));
}

void draw_picture(SvgPicture& sheet, const PictureFrame& frame, const CalibrationReport& report,
                  std::vector<CornerResidual> PoseReport::*device, const std::string& name, double rms_px) {
  const std::vector<double> lengths = residual_lengths(report, device);
  const double times = magnification(lengths, frame.scale);
  const double scale = times * frame.scale;  // sheet pixels by residual pixel
  for (std::size_t i = 0; i < report.poses.size(); ++i) {
    if (!report.poses[i].used) continue;
    for (const CornerResidual& corner : report.poses[i].*device)
      if (corner.used) draw_arrow(sheet, frame.at(corner.at), scale * corner.error, i);
  }
  draw_caption(sheet, frame, name,
               std::to_string(lengths.size()) + " corners, " + short_text(rms_px, 3) + " px RMS");
  draw_key(sheet, frame.corner + Vector2d(0, frame.size().y() + key_below), scale, times);
}

}  // namespace

std::string residual_plot(const CalibrationReport& report, const Calibration& calibration) {
  const PicturePair pictures(calibration, picture_height);
  SvgPicture sheet =
      pictures.sheet(report.poses, room_below, "Residuals",
                     "What is left of every corner used, measured minus predicted, as an enlarged arrow");
  draw_picture(sheet, pictures.camera, report, &PoseReport::camera, "Camera", report.camera_rms_px);
  draw_picture(sheet, pictures.projector, report, &PoseReport::projector, "Projector",
               report.projector_rms_px);
  return sheet.finish();
}

}  // namespace bodyscan
