#include "pipeline/drawing/plot_style.hpp"
#include "pipeline/drawing/plots.hpp"

namespace bodyscan {
namespace {

using Eigen::Vector2d;

constexpr double picture_height = 420;
constexpr double caption_height = 34;  // below the pictures

struct Count {
  int used = 0;
  int left_out = 0;
};

void draw_cross(SvgPicture& sheet, const Vector2d& center, std::size_t color) {
  constexpr double arm = 3.5;
  sheet.begin_group(R"(class="cross" stroke-width="1.3" )" + colored("stroke", color));
  sheet.line(center - Vector2d(arm, arm), center + Vector2d(arm, arm), "");
  sheet.line(center - Vector2d(arm, -arm), center + Vector2d(arm, -arm), "");
  sheet.end_group();
}

Count draw_corners(SvgPicture& sheet, const PictureFrame& frame, const std::vector<PoseReport>& poses,
                   std::vector<CornerResidual> PoseReport::*device) {
  Count count;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (const CornerResidual& corner : poses[i].*device) {
      if (poses[i].used && corner.used) {
        sheet.circle(frame.at(corner.at), 2.6, R"(class="dot" )" + colored("fill", i));
        ++count.used;
      } else {
        draw_cross(sheet, frame.at(corner.at), i);
        ++count.left_out;
      }
    }
  }
  return count;
}

void draw_picture(SvgPicture& sheet, const PictureFrame& frame, const std::vector<PoseReport>& poses,
                  std::vector<CornerResidual> PoseReport::*device, const std::string& name) {
  const Count count = draw_corners(sheet, frame, poses, device);
  draw_caption(sheet, frame, name,
               std::to_string(count.used) + " corners, " + std::to_string(count.left_out) + " left out");
}

}  // namespace

std::string coverage_plot(const CalibrationReport& report, const Calibration& calibration) {
  const PicturePair pictures(calibration, picture_height);
  SvgPicture sheet = pictures.sheet(
      report.poses, caption_height, "Coverage by corners",
      "Lenses are known where corners lie. A dot for every corner used, a cross for every one left out");
  draw_picture(sheet, pictures.camera, report.poses, &PoseReport::camera, "Camera");
  draw_picture(sheet, pictures.projector, report.poses, &PoseReport::projector, "Projector");
  return sheet.finish();
}

}  // namespace bodyscan
