#include "app/session_poses.hpp"

#include "app/interrupt.hpp"
#include "hal/replay/frame_reader.hpp"
#include "pipeline/base/number_text.hpp"
#include "pipeline/board/board_shift.hpp"
#include "pipeline/board/corner_refinement.hpp"
#include "pipeline/board/find_board.hpp"
#include "pipeline/board/gray_code_corners.hpp"
#include "pipeline/decode/decoder.hpp"

#include <algorithm>

namespace bodyscan {
namespace {

constexpr double max_shift_squares = 0.015;  // of the board between the two pictures of a pair
constexpr double max_shift_px = 1.5;

std::vector<SeenCorner> seen_corners(const ChessboardCorners& board) {
  std::vector<SeenCorner> seen;
  for (std::size_t i = 0; i < board.corners.size(); ++i)
    if (board.corners[i]) seen.push_back({static_cast<int>(i), *board.corners[i]});
  return seen;
}

std::string moved_text(double shift_px) {
  return "the board moved by " + fixed_text(shift_px, 1) + " px between the two pictures";
}

Expected<CalibrationPose> look_at_pair(const CalibrationSession& session, int index) {
  const Expected<Luma> printed = session.load_printed(index);
  if (!printed) return tl::unexpected(printed.error());
  const Expected<Luma> projected = session.load_projected(index);
  if (!projected) return tl::unexpected(projected.error());
  CalibrationPose pose;
  const Expected<FoundBoard> board = find_printed_board(*printed, session.manifest().board);
  if (!board) {
    pose.failure = board.error().message;
    return pose;
  }
  pose.edge_blur_px = board->edge_blur_px;
  pose.observation.in_camera = seen_corners(board->corners);
  const ProjectedBoard& shown = *session.manifest().projected_board;
  const Expected<FoundBoard> light = find_projected_board(*printed, *projected, *board, shown);
  if (!light) {
    pose.failure = light.error().message;
    return pose;
  }
  for (const SeenCorner& seen : seen_corners(light->corners))
    pose.observation.projected.push_back({shown.corner_px(seen.corner), seen.px});
  const std::optional<double> shift = board_shift_px(*projected, board->corners);
  if (shift.value_or(0) > std::max(max_shift_px, max_shift_squares * square_px(board->corners)))
    pose.failure = moved_text(*shift);
  return pose;
}

// The white frame's brightness and the decoded stripes of a capture, or why these show nothing.
struct Capture {
  Luma white;
  Expected<Correspondence> correspondence;
};

Expected<Capture> decode_capture(const CaptureFolder& folder) {
  const CaptureManifest& manifest = folder.manifest();
  PatternSequence sequence{manifest.projector, {}};
  for (const ManifestFrame& frame : manifest.frames) sequence.patterns.push_back(frame.pattern);
  DecodeOptions options;
  options.response = manifest.response;
  Expected<Decoder> decoder = Decoder::create(std::move(sequence), options);
  if (!decoder) return tl::unexpected(decoder.error());
  Luma white;
  Expected<void> decoded;  // frames that can be read but not decoded are the pose's failure, no error
  const Expected<void> read = for_each_frame(folder, [&](const Frame& frame) {
    if (frame.pattern.kind == PatternKind::white)
      std::visit([&](const auto& image) { white = image.clone(); }, frame.luma);
    if (decoded) decoded = decoder->consume(frame);
    return check_interrupt();
  });
  if (!read) return tl::unexpected(read.error());
  return Capture{std::move(white), decoded.and_then([&] { return decoder->finish(); })};
}

Expected<CalibrationPose> look_at_capture(const CalibrationSession& session, int index) {
  const Expected<Capture> capture = decode_capture(session.capture(index));
  if (!capture) return tl::unexpected(capture.error());
  CalibrationPose pose;
  const Expected<FoundBoard> board = find_printed_board(capture->white, session.manifest().board);
  if (!board) {
    pose.failure = board.error().message;
    return pose;
  }
  pose.edge_blur_px = board->edge_blur_px;
  pose.observation.in_camera = seen_corners(board->corners);
  auto corners = capture->correspondence.and_then(
      [&](const Correspondence& found) { return corners_in_projector(board->corners, found); });
  if (corners)
    pose.observation.in_projector = std::move(*corners);
  else
    pose.failure = corners.error().message;
  return pose;
}

}  // namespace

Expected<std::vector<CalibrationPose>> look_at_poses(const CalibrationSession& session, Progress& progress) {
  std::vector<CalibrationPose> poses;
  for (int i = 0; i < session.pose_count(); ++i) {
    if (Expected<void> going_on = check_interrupt(); !going_on) return tl::unexpected(going_on.error());
    progress.show("looking at pose", i + 1, session.pose_count());
    const PoseFiles& files = session.manifest().poses[static_cast<std::size_t>(i)];
    Expected<CalibrationPose> pose = files.is_pair() ? look_at_pair(session, i) : look_at_capture(session, i);
    if (!pose) return tl::unexpected(pose.error().within(files.name));
    pose->observation.name = files.name;
    poses.push_back(std::move(*pose));
  }
  return poses;
}

}  // namespace bodyscan
