#pragma once

#include "pipeline/board/board.hpp"
#include "tools/simulator/render_options.hpp"

#include <string>
#include <vector>

namespace bodyscan::simulator {

// How the projector's pixels are found on the board: by a Gray-code capture, by a projected chessboard, or by
// turns (the first pose projected).
enum class SessionMethod { mixed, gray, projected };

// What may go wrong with a pose.
enum class Blunder {
  cut,          // a quarter of the sheet lies outside the camera's picture
  moved,        // by 4 mm and 1 degree after the first picture
  blurred,      // the lens, by 5 px more
  size,         // a board of one column less
  scaled,       // a board whose squares are 4 % larger
  dark,         // the projector at 2 % after the first picture
  overexposed,  // six times the light
};

struct PlantedBlunder {
  int pose = 0;  // counted from 0
  Blunder kind = Blunder::cut;
};

// "cut", ...
std::string name_of(Blunder kind);
// "POSE:KIND"
Expected<PlantedBlunder> parse_blunder(const std::string& text);

// Light that leaves white paper at 0.9 m below full scale, and the blur of a sharp lens.
RenderOptions session_render_defaults();

inline constexpr double smallest_projected_share = 0.1;

// One simulated calibration session.
struct SessionOptions {
  RenderOptions render = session_render_defaults();  // its output is the session's folder
  SessionMethod method = SessionMethod::mixed;
  int poses = 7;
  PrintedBoard board{9, 7, 25};
  double bend_mm = 0;            // see SheetForm
  double plate_mm = 350;         // of projected poses: white plate beyond the sheet, for the projected board
  double projected_share = 0.6;  // of the sides of the projector's picture, spanned by the squares at most
  std::vector<PlantedBlunder> blunders;

  [[nodiscard]] bool is_gray(int pose) const {
    return method == SessionMethod::gray || (method == SessionMethod::mixed && pose % 2 == 1);
  }
  // An error of kind `usage` that names the command line's option.
  [[nodiscard]] Expected<void> check() const;
};

}  // namespace bodyscan::simulator
