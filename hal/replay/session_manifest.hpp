#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/base/image.hpp"
#include "pipeline/board/board.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace bodyscan {

// What was photographed of one pose of the board: a pair of pictures or a capture folder, never both, and not
// the same as of another pose. Plain names inside the session folder.
struct PoseFiles {
  std::string name;                      // "pose 4", counted from 0
  std::optional<std::string> printed;    // of a pair: the printed board alone
  std::optional<std::string> projected;  // of a pair: the projected board on top
  std::optional<std::string> capture;    // a folder

  [[nodiscard]] bool is_pair() const { return printed.has_value(); }
};

// session.json: the boards, and the files of every pose.
struct SessionManifest {
  PrintedBoard board;
  Size projector;
  std::optional<ProjectedBoard> projected_board;  // there if any pose is a pair; inside the picture
  std::vector<PoseFiles> poses;                   // 1 to 200
};

constexpr std::size_t max_session_bytes = std::size_t{1} << 20;

// `name` stands in front of messages: "session.json: poses[2].printed: missing". Unknown keys are ignored.
Expected<SessionManifest> parse_session(std::string_view text, const std::string& name);

}  // namespace bodyscan
