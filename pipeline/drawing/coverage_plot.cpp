#include "pipeline/base/size_text.hpp"
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
  frame.draw(sheet);
  const Count count = draw_corners(sheet, frame, poses, device);
  sheet.text(frame.corner + Vector2d(0, frame.size().y() + 20), label_size,
             name + ", " + text_of(frame.picture) + " pixels: " + std::to_string(count.used) + " corners, " +
                 std::to_string(count.left_out) + " left out",
             styled("fill", plot_ink));
}

}  // namespace

std::string coverage_plot(const CalibrationReport& report, const Calibration& calibration) {
  const Size camera = calibration.camera.size;
  const Size projector = calibration.projector.size;
  const PictureFrame first{{plot_margin, plot_head}, picture_height / camera.height, camera};
  const PictureFrame second{{first.corner.x() + first.size().x() + plot_margin, plot_head},
                            picture_height / projector.height,
                            projector};
  const PoseLegend legend(report.poses, picture_height);
  const double legend_x = second.corner.x() + second.size().x() + plot_margin;
  SvgPicture sheet = plot_sheet(
      legend_x + legend.width() + plot_margin, plot_head + picture_height + caption_height,
      "Coverage by corners",
      "Lenses are known where corners lie. A dot for every corner used, a cross for every one left out");
  draw_picture(sheet, first, report.poses, &PoseReport::camera, "Camera");
  draw_picture(sheet, second, report.poses, &PoseReport::projector, "Projector");
  legend.draw(sheet, {legend_x, plot_head});
  return sheet.finish();
}

}  // namespace bodyscan
