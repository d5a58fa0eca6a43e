#include "hal/replay/session_manifest.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

namespace {

bool is_plain(const std::optional<std::string>& name) {
  return !name || (!name->empty() && name->find('/') == std::string::npos && *name != "..");
}

template <class Board>
bool has_corners(const Board& board) {
  return std::min(board.columns, board.rows) >= 3 && std::max(board.columns, board.rows) <= 100;
}

// What the parser promises of every session that it accepts.
bool keeps_promises(const bodyscan::SessionManifest& session) {
  if (!has_corners(session.board) || !(session.board.square_mm > 0 && session.board.square_mm < 1000))
    return false;
  if (session.projected_board) {
    const bodyscan::ProjectedBoard& board = *session.projected_board;
    if (!has_corners(board)) return false;
    for (int i = 0; i < board.corner_count(); ++i) {
      const Eigen::Vector2d corner = board.corner_px(i);
      if (!(corner.minCoeff() >= 0 && corner.x() < session.projector.width &&
            corner.y() < session.projector.height))
        return false;
    }
  }
  if (session.poses.empty() || session.poses.size() > 200) return false;
  return std::all_of(session.poses.begin(), session.poses.end(), [&](const bodyscan::PoseFiles& pose) {
    const bool pair = pose.printed && pose.projected && session.projected_board;
    return is_plain(pose.printed) && is_plain(pose.projected) && is_plain(pose.capture) &&
           pair != pose.capture.has_value() && pose.is_pair() == pose.projected.has_value();
  });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto session = bodyscan::parse_session(text, "fuzz.json");
  if (session && !keeps_promises(*session)) std::abort();
  return 0;
}
