#include "pipeline/base/number_text.hpp"
#include "pipeline/drawing/plot_style.hpp"
#include "pipeline/drawing/plots.hpp"

#include <algorithm>
#include <cmath>

namespace bodyscan {
namespace {

using Eigen::Vector2d;

constexpr double axes_width = 500;
constexpr double axes_height = 320;
constexpr double left_room = 56;   // counts, before the axes
constexpr double below_room = 56;  // lengths, below them
constexpr double above_room = 26;

struct Histogram {
  double bin_px = 1;
  std::vector<int> counts;
  int beyond = 0;  // longer than the last bin; counted in it

  [[nodiscard]] double length_px() const { return bin_px * static_cast<double>(counts.size()); }
  [[nodiscard]] int highest() const { return std::max(1, *std::max_element(counts.begin(), counts.end())); }
};

// Bins up to five times the RMS at most, since a few long ones would squeeze the others together.
Histogram histogram_of(const std::vector<double>& lengths) {
  Histogram histogram;
  const double longest = lengths.empty() ? 0 : *std::max_element(lengths.begin(), lengths.end());
  const double shown = std::min(longest, 5 * rms_of(lengths));
  if (shown > 0) histogram.bin_px = round_length(shown / 15);
  histogram.counts.assign(static_cast<std::size_t>(shown / histogram.bin_px) + 1, 0);
  for (const double length : lengths) {
    const auto bin = static_cast<std::size_t>(length / histogram.bin_px);
    if (bin >= histogram.counts.size()) ++histogram.beyond;
    ++histogram.counts[std::min(bin, histogram.counts.size() - 1)];
  }
  return histogram;
}

// A histogram's axes on the sheet.
struct Axes {
  Vector2d origin;
  double width_px;  // residual pixels
  double height;    // corners

  [[nodiscard]] Vector2d at(double px, double count) const {
    return origin + Vector2d(axes_width * px / width_px, -axes_height * count / height);
  }
};

void draw_axes(SvgPicture& sheet, const Axes& axes, const Histogram& histogram) {
  const double count_step = std::max(1.0, round_length(axes.height / 4));
  for (double count = 0; count <= axes.height; count += count_step) {
    const Vector2d place = axes.at(0, count);
    sheet.line(place, place + Vector2d(axes_width, 0), R"(stroke="#e4e4e4")");
    sheet.text(place + Vector2d(-8, 4.5), label_size, short_text(count, 0),
               R"(text-anchor="end" )" + styled("fill", plot_ink));
  }
  const double length_step = round_length(axes.width_px / 4);
  for (int i = 0; i * length_step <= axes.width_px * (1 + 1e-9); ++i) {
    const Vector2d place = axes.at(i * length_step, 0);
    sheet.line(place, place + Vector2d(0, 5), styled("stroke", plot_ink));
    sheet.text(place + Vector2d(0, 20), label_size, short_text(i * length_step, 9),
               R"(text-anchor="middle" )" + styled("fill", plot_ink));
  }
  const std::string beyond =
      histogram.beyond == 0 ? ""
                            : "; the last bar holds " + std::to_string(histogram.beyond) + " longer ones";
  sheet.text(axes.origin + Vector2d(axes_width / 2, 42), label_size, "residual, px" + beyond,
             R"(text-anchor="middle" )" + styled("fill", plot_ink));
}

void draw_histogram(SvgPicture& sheet, const Vector2d& origin, const std::vector<double>& lengths, double rms,
                    const std::string& name, std::size_t color) {
  const Histogram histogram = histogram_of(lengths);
  const Axes axes{origin, histogram.length_px(), 1.08 * histogram.highest()};
  sheet.text(origin - Vector2d(0, axes_height + 12), label_size + 2,
             name + ": " + std::to_string(lengths.size()) + " corners, " + short_text(rms, 3) + " px RMS",
             R"(font-weight="bold" )" + styled("fill", plot_ink));
  draw_axes(sheet, axes, histogram);
  for (std::size_t bin = 0; bin < histogram.counts.size(); ++bin) {
    if (histogram.counts[bin] == 0) continue;
    const double from = static_cast<double>(bin) * histogram.bin_px;
    const Vector2d top = axes.at(from, histogram.counts[bin]);
    const Vector2d foot = axes.at(from + histogram.bin_px, 0);
    sheet.rectangle(top, foot - top, R"(class="bar" stroke="#fff" )" + colored("fill", color));
  }
  sheet.line(origin, origin + Vector2d(axes_width, 0), styled("stroke", plot_ink));
  if (rms > 0 && rms <= axes.width_px)
    sheet.line(axes.at(rms, 0), axes.at(rms, axes.height),
               R"(stroke-dasharray="5 4" )" + styled("stroke", plot_ink));
}

}  // namespace

std::string residual_histogram(const CalibrationReport& report) {
  const double axes_step = left_room + axes_width + plot_margin;
  SvgPicture sheet =
      plot_sheet(2 * axes_step + plot_margin, plot_head + above_room + axes_height + below_room,
                 "Residuals' lengths", "How many of the corners used; the dashed line is the RMS");
  const Vector2d origin(plot_margin + left_room, plot_head + above_room + axes_height);
  draw_histogram(sheet, origin, residual_lengths(report, &PoseReport::camera), report.camera_rms_px, "Camera",
                 0);
  draw_histogram(sheet, origin + Vector2d(axes_step, 0), residual_lengths(report, &PoseReport::projector),
                 report.projector_rms_px, "Projector", 1);
  return sheet.finish();
}

}  // namespace bodyscan
