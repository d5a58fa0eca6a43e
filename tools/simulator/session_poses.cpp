#include "tools/simulator/session_poses.hpp"

#include "tools/simulator/option_range.hpp"
#include "tools/simulator/projected_chessboard.hpp"

#include <array>
#include <numbers>
#include <string>

#include <Eigen/Geometry>

namespace bodyscan::simulator {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

struct Stand {
  double pitch, yaw, roll;  // degrees: about x, then y, then z of the board
  double distance_mm;       // of the board's middle along the camera's axis
  double right, down;       // -1 to 1: share of the way to the picture's borders, if it is seen there
};

// Every run of seven, and its even and its odd half, has tilts to all four sides and boards near all borders.
constexpr std::array<Stand, most_session_poses> stands{{{22, 8, 0, 1050, 0, 0},
                                                        {-12, -30, 12, 960, -1, -1},
                                                        {-28, 14, -9, 1020, 1, 1},
                                                        {10, 32, 7, 1100, 1, -1},
                                                        {26, -18, -16, 1120, -1, 1},
                                                        {-29, 4, 18, 1060, 0.4, 1},
                                                        {-6, -34, -5, 1000, 0, -1},
                                                        {2, -3, 3, 900, 0, 0},
                                                        {-20, -22, -20, 1180, -1, -0.4},
                                                        {34, 10, 15, 1080, 1, -1},
                                                        {-10, 35, -12, 960, -1, 1},
                                                        {24, -24, 20, 1200, 1, 0.3},
                                                        {-30, -10, -4, 1150, -1, 0.5},
                                                        {15, 20, 9, 940, 1, 0}}};
constexpr double room_to_slide = 0.95;  // of the way to one border: then along it
constexpr double border = 0.01;         // of a picture's width that stays free

bool in_picture(const Lens& lens, const Vector3d& point) {
  if (point.z() <= 0) return false;
  const Vector2d pixel = lens.project(point);
  const double free = border * lens.size.width;
  return pixel.x() >= free && pixel.y() >= free && pixel.x() <= lens.size.width - 1 - free &&
         pixel.y() <= lens.size.height - 1 - free;
}

// Whether camera and projector see the whole sheet, from the front.
bool sees_sheet(const Calibration& calibration, const PrintedSheet& sheet,
                const RigidTransform& camera_from_board) {
  constexpr double smallest_cosine = 0.3;
  constexpr int steps = 8;  // along each side: the sheet may be bent, the lens bends its image
  const RigidTransform& rig = calibration.projector_from_camera;
  const Vector3d projector_center = -(rig.rotation.transpose() * rig.translation);
  const Vector3d front = -camera_from_board.rotation.col(2);
  for (int j = -steps; j <= steps; ++j) {
    for (int i = -steps; i <= steps; ++i) {
      const Vector2d way = Vector2d(i, j) / steps;
      const Vector3d point =
          camera_from_board * sheet.point(sheet.middle() + way.cwiseProduct(sheet.half_sheet()));
      if (!in_picture(calibration.camera, point) || !in_picture(calibration.projector, rig * point))
        return false;
      if (front.dot((projector_center - point).normalized()) < smallest_cosine ||
          front.dot(-point.normalized()) < smallest_cosine)
        return false;
    }
  }
  return true;
}

// Whether the camera sees all of the projected squares, on sheet and plate.
bool sees_projected(const Calibration& calibration, const ProjectedBoard& projected,
                    const PrintedSheet& sheet, const RigidTransform& camera_from_board) {
  const ProjectedBoard outer{projected.columns + 2, projected.rows + 2,
                             projected.first_corner_px.array() - projected.square_px, projected.square_px};
  const auto corners = projected_corners(calibration, outer, sheet, camera_from_board);
  for (const Vector3d& corner : corners) {
    if (!in_picture(calibration.camera, corner)) return false;
  }
  return !corners.empty();
}

const Stand& stand_of(int pose) {
  return stands[static_cast<std::size_t>(pose)];
}

// Edges fade over the width of a ray, so that rays sample them where they are.
PrintedSheet sheet_of(int pose, const SessionOptions& options, const Calibration& calibration) {
  const double ray_mm = stand_of(pose).distance_mm / calibration.camera.fx / options.render.rays;
  return {options.board, {options.bend_mm, options.is_gray(pose) ? 0 : options.plate_mm, ray_mm}};
}

Matrix3d rotation_of(const Stand& stand) {
  constexpr double degree = std::numbers::pi / 180;
  return (Eigen::AngleAxisd(stand.pitch * degree, Vector3d::UnitX()) *
          Eigen::AngleAxisd(stand.yaw * degree, Vector3d::UnitY()) *
          Eigen::AngleAxisd(stand.roll * degree, Vector3d::UnitZ()))
      .toRotationMatrix();
}

// With the sheet's middle on the ray of the pixel that lies `way` (1: all) of the stand's way to the
// picture's borders.
RigidTransform placed(const Stand& stand, const Vector2d& way, const Lens& camera,
                      const PrintedSheet& sheet) {
  const Eigen::Array2d half(camera.size.width / 2.0, camera.size.height / 2.0);
  const Vector2d pixel = half - 0.5 + half * way.array() * Eigen::Array2d(stand.right, stand.down);
  RigidTransform pose{rotation_of(stand), {}};
  pose.translation = stand.distance_mm * camera.ray(pixel) - pose.rotation * sheet.point(sheet.middle());
  return pose;
}

// How far from `start` towards `start + step` is still seen.
template <class Seen>
Vector2d farthest(const Vector2d& start, const Vector2d& step, const Seen& seen) {
  double share = 0;
  for (double more = 0.5; more > 1e-4; more /= 2) {
    if (share + more > 1 || !seen(start + (share + more) * step)) continue;
    share += more;
  }
  return start + share * step;
}

}  // namespace

std::vector<Vector3d> projected_corners(const Calibration& calibration, const ProjectedBoard& projected,
                                        const PrintedSheet& sheet, const RigidTransform& camera_from_board) {
  const RigidTransform& rig = calibration.projector_from_camera;
  const Matrix3d board_from_camera = camera_from_board.rotation.transpose();
  const Vector3d center = -(rig.rotation.transpose() * rig.translation);
  const Vector3d origin = board_from_camera * (center - camera_from_board.translation);
  std::vector<Vector3d> corners;
  for (int i = 0; i < projected.corner_count(); ++i) {
    const Vector3d ray = rig.rotation.transpose() * calibration.projector.ray(projected.corner_px(i));
    const std::optional<Vector2d> paper = sheet.hit(origin, board_from_camera * ray);
    if (!paper) return {};
    corners.push_back(camera_from_board * sheet.point(*paper));
  }
  return corners;
}

Expected<ProjectedBoard> plan_projected_board(const SessionOptions& options, const Calibration& calibration) {
  constexpr int columns = 9;
  constexpr int rows = 7;
  const auto seen = [&](const ProjectedBoard& board) {
    for (int i = 0; i < options.poses; ++i) {
      const PrintedSheet sheet = sheet_of(i, options, calibration);
      const RigidTransform pose = placed(stand_of(i), Vector2d::Zero(), calibration.camera, sheet);
      if (!options.is_gray(i) && !sees_projected(calibration, board, sheet, pose)) return false;
    }
    return true;
  };
  for (double share = options.projected_share; share >= smallest_projected_share; share *= 0.97) {
    const ProjectedBoard board = fit_projected_board(calibration.projector.size, columns, rows, share);
    if (board.square_px == 0) break;
    if (seen(board)) return board;
  }
  return usage_error("--plate, --projector: the camera does not see a whole projected board in every pose");
}

Expected<std::vector<SessionPose>> plan_poses(const SessionOptions& options, const Calibration& calibration,
                                              const ProjectedBoard& projected) {
  std::vector<SessionPose> poses;
  for (int i = 0; i < options.poses; ++i) {
    const bool gray = options.is_gray(i);
    const PrintedSheet sheet = sheet_of(i, options, calibration);
    const auto at = [&](const Vector2d& way) { return placed(stand_of(i), way, calibration.camera, sheet); };
    const auto seen = [&](const Vector2d& way) {
      return sees_sheet(calibration, sheet, at(way)) &&
             (gray || sees_projected(calibration, projected, sheet, at(way)));
    };
    Vector2d way = Vector2d::Zero();
    if (!seen(way))
      return usage_error(
          "--columns, --rows, --square-mm: camera and projector do not both see the whole board of pose " +
          std::to_string(i));
    way = room_to_slide * farthest(way, Vector2d(1, 1), seen);
    way = farthest(way, (1 - way.x()) * Vector2d::UnitX(), seen);
    way = farthest(way, (1 - way.y()) * Vector2d::UnitY(), seen);
    poses.push_back({gray,
                     sheet,
                     at(way),
                     at(way),
                     options.render.light,
                     options.render.light,
                     options.render.lens_blur,
                     {}});
  }
  return poses;
}

}  // namespace bodyscan::simulator
