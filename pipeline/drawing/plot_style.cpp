#include "pipeline/drawing/plot_style.hpp"

#include "pipeline/base/number_text.hpp"
#include "pipeline/base/size_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace bodyscan {
namespace {

constexpr double legend_row = 20;
constexpr double legend_column = 150;

std::string color_of(std::size_t index) {
  // Tableau's ten; after them hues a golden angle apart.
  constexpr std::array<const char*, 10> named = {"#1f77b4", "#ff7f0e", "#2ca02c", "#d62728", "#9467bd",
                                                 "#8c564b", "#e377c2", "#17becf", "#bcbd22", "#7f7f7f"};
  if (index < named.size()) return named[index];
  const double hue = std::fmod(137.508 * static_cast<double>(index), 360);
  return "hsl(" + short_text(hue, 0) + ",60%,45%)";
}

}  // namespace

double round_length(double limit) {
  const double power = std::pow(10, std::floor(std::log10(limit)));
  for (const double step : {5.0, 2.0})
    if (step * power <= limit) return step * power;
  return power;
}

std::string styled(std::string_view name, std::string_view value) {
  std::string attribute(name);
  attribute.append("=\"").append(value).append("\"");
  return attribute;
}

std::string colored(std::string_view name, std::size_t index) {
  return styled(name, color_of(index));
}

SvgPicture plot_sheet(double width, double height, const std::string& title, const std::string& subtitle) {
  SvgPicture sheet(width, height, "", title);
  sheet.rectangle({0, 0}, {width, height}, R"(fill="#fff")");
  sheet.text({plot_margin, 34}, 20, title, R"(font-weight="bold" fill="#111")");
  sheet.text({plot_margin, 56}, label_size, subtitle, styled("fill", plot_ink));
  return sheet;
}

PoseLegend::PoseLegend(const std::vector<PoseReport>& poses, double height)
    : poses_(poses), rows_(static_cast<std::size_t>(std::max(1.0, height / legend_row))) {}

double PoseLegend::width() const {
  const std::size_t columns = (poses_.size() + rows_ - 1) / rows_;
  return legend_column * static_cast<double>(columns);
}

void PoseLegend::draw(SvgPicture& sheet, const Eigen::Vector2d& corner) const {
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const std::size_t column = i / rows_;
    const Eigen::Vector2d place(static_cast<double>(column) * legend_column,
                                (static_cast<double>(i % rows_) + 0.5) * legend_row);
    const Eigen::Vector2d middle = corner + place + Eigen::Vector2d(6, 0);
    const std::string label = poses_[i].name + (poses_[i].used ? "" : " (left out)");
    sheet.circle(middle, 5, colored(poses_[i].used ? "fill" : R"(fill="none" stroke-width="1.5" stroke)", i));
    sheet.text(middle + Eigen::Vector2d(12, 4.5), label_size, label, styled("fill", plot_ink));
  }
}

void PictureFrame::draw(SvgPicture& sheet) const {
  sheet.rectangle(corner, size(), R"(fill="#f7f7f7" stroke="#888")");
  for (const double third : {1.0 / 3, 2.0 / 3}) {
    const Eigen::Vector2d inside = third * size();
    sheet.line(corner + Eigen::Vector2d(inside.x(), 0), corner + Eigen::Vector2d(inside.x(), size().y()),
               R"(stroke="#e4e4e4")");
    sheet.line(corner + Eigen::Vector2d(0, inside.y()), corner + Eigen::Vector2d(size().x(), inside.y()),
               R"(stroke="#e4e4e4")");
  }
}

PicturePair::PicturePair(const Calibration& calibration, double height)
    : camera{{plot_margin, plot_head}, height / calibration.camera.size.height, calibration.camera.size},
      projector{{2 * plot_margin + camera.size().x(), plot_head},
                height / calibration.projector.size.height,
                calibration.projector.size} {}

SvgPicture PicturePair::sheet(const std::vector<PoseReport>& poses, double below, const std::string& title,
                              const std::string& subtitle) const {
  const double height = camera.size().y();
  const double legend_x = projector.corner.x() + projector.size().x() + plot_margin;
  const PoseLegend legend(poses, height);
  SvgPicture sheet =
      plot_sheet(legend_x + legend.width() + plot_margin, plot_head + height + below, title, subtitle);
  camera.draw(sheet);
  projector.draw(sheet);
  legend.draw(sheet, {legend_x, plot_head});
  return sheet;
}

void draw_caption(SvgPicture& sheet, const PictureFrame& frame, const std::string& device,
                  const std::string& content) {
  sheet.text(frame.corner + Eigen::Vector2d(0, frame.size().y() + 20), label_size,
             device + ", " + text_of(frame.picture) + " pixels: " + content, styled("fill", plot_ink));
}

double rms_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return values.empty() ? 0 : std::sqrt(sum / static_cast<double>(values.size()));
}

std::vector<double> residual_lengths(const CalibrationReport& report,
                                     std::vector<CornerResidual> PoseReport::*device) {
  std::vector<double> lengths;
  for (const PoseReport& pose : report.poses) {
    for (const CornerResidual& corner : pose.*device) {
      if (pose.used && corner.used && corner.error.allFinite()) lengths.push_back(corner.error.norm());
    }
  }
  return lengths;
}

}  // namespace bodyscan
