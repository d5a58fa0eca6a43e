#include "pipeline/base/number_text.hpp"
#include "pipeline/drawing/plot_style.hpp"
#include "pipeline/drawing/plots.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

namespace bodyscan {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double drawing_width = 760;
constexpr double drawing_height = 560;
constexpr double name_width = 76;   // left of the drawing: "projector"
constexpr double axes_height = 96;  // below it
constexpr double label_row = 18;
constexpr double label_width = 150;  // right of it
constexpr std::size_t most_labels = 25;

// Isometric, seen from the right, above and behind the camera: x to the lower right, y down, z (away from the
// camera) to the upper right. One millimetre has the same length along all three.
Vector2d isometric(const Vector3d& point) {
  const double cos30 = std::sqrt(0.75);
  return {cos30 * (point.x() + point.z()), point.y() + 0.5 * (point.x() - point.z())};
}

// Grows along the line of sight.
double sight_depth(const Vector3d& point) {
  return point.y() + point.z() - point.x();
}

struct Shape {
  std::array<Vector3d, 4> corners;  // mm, camera frame

  [[nodiscard]] Vector3d middle() const { return (corners[0] + corners[1] + corners[2] + corners[3]) / 4; }
};

struct BoardShape : Shape {
  std::size_t pose;
};

// The picture's four corners at depth `length_mm` before the lens, without distortion.
Shape frustum_base(const Lens& lens, const RigidTransform& camera_from_lens, double length_mm) {
  const double right = lens.size.width - 0.5;
  const double bottom = lens.size.height - 0.5;
  const std::array<Vector2d, 4> pixels = {
      Vector2d(-0.5, -0.5), {right, -0.5}, {right, bottom}, {-0.5, bottom}};
  Shape base;
  for (std::size_t i = 0; i < pixels.size(); ++i)
    base.corners[i] = camera_from_lens * (length_mm * Vector3d((pixels[i].x() - lens.cx) / lens.fx,
                                                               (pixels[i].y() - lens.cy) / lens.fy, 1));
  return base;
}

// The outer squares' rim of every board whose pose is known, the farthest first.
std::vector<BoardShape> board_shapes(const std::vector<PoseReport>& poses, const PrintedBoard& board) {
  const double left = -board.square_mm;
  const double right = board.square_mm * board.columns;
  const double bottom = board.square_mm * board.rows;
  std::vector<BoardShape> shapes;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const RigidTransform& pose = poses[i].camera_from_board;
    const Shape shape{{pose * Vector3d(left, left, 0), pose * Vector3d(right, left, 0),
                       pose * Vector3d(right, bottom, 0), pose * Vector3d(left, bottom, 0)}};
    const Vector3d middle = shape.middle();
    if (middle.allFinite() && pose.translation.z() > 0 && middle.z() > 0) shapes.push_back({shape, i});
  }
  std::sort(shapes.begin(), shapes.end(), [](const BoardShape& a, const BoardShape& b) {
    return sight_depth(a.middle()) > sight_depth(b.middle());
  });
  return shapes;
}

// From millimetres in the camera frame to the sheet.
class View {
 public:
  explicit View(const std::vector<Vector3d>& points) {
    Vector2d low = isometric(points.front());
    Vector2d high = low;
    for (const Vector3d& point : points) {
      low = low.cwiseMin(isometric(point));
      high = high.cwiseMax(isometric(point));
    }
    const Vector2d extent = (high - low).cwiseMax(1e-6);
    scale_ = std::min(drawing_width / extent.x(), drawing_height / extent.y());
    offset_ = Vector2d(plot_margin + name_width, plot_head) +
              (Vector2d(drawing_width, drawing_height) - scale_ * (low + high)) / 2;
  }
  [[nodiscard]] Vector2d at(const Vector3d& point) const { return offset_ + scale_ * isometric(point); }
  [[nodiscard]] double scale() const { return scale_; }

 private:
  double scale_ = 1;
  Vector2d offset_;
};

std::array<Vector2d, 4> outline_of(const Shape& shape, const View& view) {
  std::array<Vector2d, 4> outline;
  std::transform(shape.corners.begin(), shape.corners.end(), outline.begin(),
                 [&](const Vector3d& corner) { return view.at(corner); });
  return outline;
}

// The name stands left of the tip, lower by `lower`.
void draw_frustum(SvgPicture& sheet, const View& view, const Vector3d& tip, const Shape& base,
                  const std::string& name, double lower) {
  const std::array<Vector2d, 4> outline = outline_of(base, view);
  sheet.begin_group(R"(class="frustum" stroke-width="1.4" fill="#333" fill-opacity="0.08" )" +
                    styled("stroke", plot_ink));
  for (const Vector2d& corner : outline) sheet.line(view.at(tip), corner, "");
  sheet.polygon(outline, "");
  sheet.end_group();
  sheet.text(view.at(tip) + Vector2d(-6, 4.5 + lower), label_size, name,
             R"(text-anchor="end" font-weight="bold" paint-order="stroke" stroke="#fff" stroke-width="3" )" +
                 styled("fill", plot_ink));
}

void draw_board(SvgPicture& sheet, const View& view, const BoardShape& board, bool used) {
  const std::string style =
      used ? R"(class="board" stroke-width="1.6" fill-opacity="0.14" )" + colored("fill", board.pose)
           : R"(class="board" stroke-width="1.6" fill="none" stroke-dasharray="6 4")";
  sheet.polygon(outline_of(board, view), style + " " + colored("stroke", board.pose));
}

// Names in a column right of the drawing, in the order of the boards' right corners, a line to each.
void draw_labels(SvgPicture& sheet, const View& view, const std::vector<BoardShape>& boards,
                 const std::vector<PoseReport>& poses) {
  struct Label {
    Vector2d anchor;
    std::size_t pose;
  };
  std::vector<Label> labels;
  for (const BoardShape& board : boards) {
    const std::array<Vector2d, 4> outline = outline_of(board, view);
    const auto right = std::max_element(outline.begin(), outline.end(),
                                        [](const auto& a, const auto& b) { return a.x() < b.x(); });
    labels.push_back({*right, board.pose});
  }
  std::sort(labels.begin(), labels.end(),
            [](const Label& a, const Label& b) { return a.anchor.y() < b.anchor.y(); });
  double next = plot_head + label_row / 2;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const double room_below = static_cast<double>(labels.size() - i) * label_row;
    const double y = std::max(next, std::min(labels[i].anchor.y(), plot_head + drawing_height - room_below));
    next = y + label_row;
    const Vector2d place(2 * plot_margin + name_width + drawing_width, y);
    const std::size_t pose = labels[i].pose;
    sheet.line(labels[i].anchor, place - Vector2d(6, 0), R"(stroke-width="0.7" )" + colored("stroke", pose));
    sheet.text(place + Vector2d(0, 4.5), label_size,
               poses[pose].name + (poses[pose].used ? "" : " (left out)"), colored("fill", pose));
  }
}

// Three axes that show directions and a length.
void draw_axes(SvgPicture& sheet, const View& view, const Vector2d& place) {
  const double length_mm = round_length(55 / view.scale());
  const std::array<Vector3d, 3> axes = {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
  const std::array<const char*, 3> names = {"x", "y", "z"};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const Vector2d along = view.scale() * length_mm * isometric(axes[i]);
    sheet.line(place, place + along, styled("stroke", plot_ink));
    sheet.text(place + along + 10 * along.normalized() + Vector2d(0, 4.5), label_size, names[i],
               R"(text-anchor="middle" )" + styled("fill", plot_ink));
  }
  sheet.text(place + Vector2d(-8, 4.5), label_size, short_text(length_mm, 6) + " mm",
             R"(text-anchor="end" )" + styled("fill", plot_ink));
}

}  // namespace

std::string pose_plot(const CalibrationReport& report, const Calibration& calibration,
                      const PrintedBoard& board) {
  const std::vector<BoardShape> boards = board_shapes(report.poses, board);
  const RigidTransform camera_from_projector = calibration.projector_from_camera.inverse();
  const Vector3d camera = Vector3d::Zero();
  const Vector3d projector = camera_from_projector.translation;
  double farthest = 500;
  for (const BoardShape& shape : boards) farthest = std::max(farthest, shape.middle().z());
  const Shape camera_base = frustum_base(calibration.camera, {}, farthest / 6);
  const Shape projector_base = frustum_base(calibration.projector, camera_from_projector, farthest / 6);

  std::vector<Vector3d> points = {camera, projector};
  for (const Shape& shape : {camera_base, projector_base})
    points.insert(points.end(), shape.corners.begin(), shape.corners.end());
  for (const BoardShape& shape : boards)
    points.insert(points.end(), shape.corners.begin(), shape.corners.end());
  const View view(points);

  const PoseLegend legend(report.poses, drawing_height);
  const bool labels = boards.size() <= most_labels;
  const double right = name_width + drawing_width + 2 * plot_margin;
  SvgPicture sheet =
      plot_sheet(right + (labels ? label_width : legend.width()) + plot_margin,
                 plot_head + drawing_height + axes_height, "Boards before camera and projector",
                 "Seen from the right, above and behind the camera; dashed boards were left out");
  for (const BoardShape& shape : boards) draw_board(sheet, view, shape, report.poses[shape.pose].used);
  const double between = view.at(camera).y() - view.at(projector).y();
  const double apart = std::abs(between) < label_row ? std::copysign(label_row / 2, between) : 0;
  draw_frustum(sheet, view, camera, camera_base, "camera", apart);
  draw_frustum(sheet, view, projector, projector_base, "projector", -apart);
  if (labels)
    draw_labels(sheet, view, boards, report.poses);
  else
    legend.draw(sheet, {right, plot_head});
  draw_axes(sheet, view, {plot_margin + 70, plot_head + drawing_height + 30});
  return sheet.finish();
}

}  // namespace bodyscan
