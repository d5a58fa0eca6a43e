#include "hal/replay/session_manifest.hpp"

#include "hal/replay/manifest_fields.hpp"
#include "pipeline/base/size_text.hpp"
#include "pipeline/board/board_limits.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bodyscan {
namespace {

constexpr std::size_t max_poses = 200;

Expected<int> corners_along(const JsonNode& node) {
  return integer_between(node, min_board_corners, max_board_corners);
}

Expected<double> square_mm_of(const JsonNode& node) {
  return json_positive(node).and_then([&](double side) -> Expected<double> {
    if (side < min_square_mm || side >= max_square_mm) return node.error("must be 0.1 to 1000");
    return side;
  });
}

Expected<double> square_px_of(const JsonNode& node) {
  return json_positive(node).and_then([&](double side) -> Expected<double> {
    if (side < min_square_px) return node.error("must be 2 or more");
    return side;
  });
}

Expected<Eigen::Vector2d> point_of(const JsonNode& node) {
  const nlohmann::json& value = *node.value;
  if (!value.is_array() || value.size() != 2 || !value[0].is_number() || !value[1].is_number())
    return node.error("not an array of two numbers");
  return Eigen::Vector2d(value[0].get<double>(), value[1].get<double>());
}

// The keys "columns" and "rows" of either board.
template <class Board>
Expected<Board> corners_of(const JsonNode& node) {
  if (!node.value->is_object()) return node.error("not an object");
  const Expected<int> columns = required(node, "columns", corners_along);
  if (!columns) return tl::unexpected(columns.error());
  const Expected<int> rows = required(node, "rows", corners_along);
  if (!rows) return tl::unexpected(rows.error());
  Board board;
  board.columns = *columns;
  board.rows = *rows;
  return board;
}

Expected<PrintedBoard> printed_board(const JsonNode& node) {
  Expected<PrintedBoard> board = corners_of<PrintedBoard>(node);
  if (!board) return board;
  const Expected<double> side = required(node, "square_mm", square_mm_of);
  if (!side) return tl::unexpected(side.error());
  board->square_mm = *side;
  return board;
}

bool is_inside(const Eigen::Vector2d& point, Size picture) {
  return point.x() >= 0 && point.y() >= 0 && point.x() <= picture.width - 1 &&
         point.y() <= picture.height - 1;
}

Expected<ProjectedBoard> projected_board(const JsonNode& node, Size projector) {
  Expected<ProjectedBoard> board = corners_of<ProjectedBoard>(node);
  if (!board) return board;
  const Expected<Eigen::Vector2d> first = required(node, "first_corner_px", point_of);
  if (!first) return tl::unexpected(first.error());
  board->first_corner_px = *first;
  const Expected<double> side = required(node, "square_px", square_px_of);
  if (!side) return tl::unexpected(side.error());
  board->square_px = *side;
  if (!is_inside(board->corner_px(0), projector) ||
      !is_inside(board->corner_px(board->corner_count() - 1), projector))
    return node.error("corners lie outside the projector's picture of " + text_of(projector));
  return board;
}

Expected<void> read_pair(const JsonNode& node, PoseFiles& pose) {
  Expected<std::string> printed = required(node, "printed", plain_name);
  if (!printed) return tl::unexpected(printed.error());
  const Expected<JsonNode> projected_node = node.member("projected");
  Expected<std::string> projected = projected_node.and_then(plain_name);
  if (!projected) return tl::unexpected(projected.error());
  if (*printed == *projected) return projected_node->error("the same file as printed");
  pose.printed = std::move(*printed);
  pose.projected = std::move(*projected);
  return {};
}

Expected<PoseFiles> pose_of(const JsonNode& node, std::size_t index) {
  if (!node.value->is_object()) return node.error("not an object");
  PoseFiles pose;
  pose.name = "pose " + std::to_string(index);
  const bool pair = node.has("printed") || node.has("projected");
  if (pair == node.has("capture"))
    return node.error(pair ? "both a pair of pictures and a capture"
                           : "neither a pair of pictures (printed, projected) nor a capture");
  if (Expected<void> read =
          pair ? read_pair(node, pose) : read_if_present(node, "capture", plain_name, pose.capture);
      !read)
    return tl::unexpected(read.error());
  return pose;
}

// The same pictures again tell nothing, but would count.
Expected<void> check_other(const JsonNode& node, const PoseFiles& pose,
                           const std::vector<PoseFiles>& before) {
  const auto same = std::ranges::find_if(before, [&](const PoseFiles& other) {
    return other.printed == pose.printed && other.projected == pose.projected &&
           other.capture == pose.capture;
  });
  if (same == before.end()) return {};
  return node.error("the same as poses[" + std::to_string(same - before.begin()) + "]");
}

Expected<std::vector<PoseFiles>> poses_of(const JsonNode& node) {
  if (!node.value->is_array()) return node.error("not an array");
  const std::size_t count = node.value->size();
  if (count == 0 || count > max_poses)
    return node.error("there must be 1 to " + std::to_string(max_poses) + ", not " + std::to_string(count));
  std::vector<PoseFiles> poses;
  for (std::size_t i = 0; i < count; ++i) {
    const JsonNode item{&(*node.value)[i], node.place + "[" + std::to_string(i) + "]"};
    Expected<PoseFiles> pose = pose_of(item, i);
    if (!pose) return tl::unexpected(pose.error());
    if (Expected<void> other = check_other(item, *pose, poses); !other) return tl::unexpected(other.error());
    poses.push_back(std::move(*pose));
  }
  return poses;
}

Expected<SessionManifest> session_of(const JsonNode& root) {
  if (Expected<void> format = check_format(root, "bodyscan-calibration-session"); !format)
    return tl::unexpected(format.error());
  SessionManifest session;
  const Expected<PrintedBoard> board = required(root, "board", printed_board);
  if (!board) return tl::unexpected(board.error());
  session.board = *board;
  const Expected<Size> projector = required(root, "projector", projector_size);
  if (!projector) return tl::unexpected(projector.error());
  session.projector = *projector;
  const auto read_projected = [&](const JsonNode& node) { return projected_board(node, *projector); };
  if (Expected<void> read = read_if_present(root, "projected_board", read_projected, session.projected_board);
      !read)
    return tl::unexpected(read.error());
  Expected<std::vector<PoseFiles>> poses = required(root, "poses", poses_of);
  if (!poses) return tl::unexpected(poses.error());
  const auto pair =
      std::find_if(poses->begin(), poses->end(), [](const auto& pose) { return pose.is_pair(); });
  if (pair != poses->end() && !session.projected_board)
    return input_error("projected_board: missing, but poses[" + std::to_string(pair - poses->begin()) +
                       "] is a pair of pictures");
  session.poses = std::move(*poses);
  return session;
}

}  // namespace

Expected<SessionManifest> parse_session(std::string_view text, const std::string& name) {
  return read_document(text, name, max_session_bytes, session_of);
}

}  // namespace bodyscan
