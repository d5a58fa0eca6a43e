#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/board/chessboard.hpp"
#include "pipeline/board/observations.hpp"
#include "pipeline/decode/correspondence.hpp"

#include <vector>

namespace bodyscan {

// Where the projector sees the printed corners: about each, a homography from camera to projector pixels is
// fitted to the decoded pixels within half a square, weighted by their sigma (Moreno and Taubin 2012).
// Corners with too few decoded pixels are left out. Errors: an axis is missing, most corners are not decoded,
// the picture is mirrored.
Expected<std::vector<SeenCorner>> corners_in_projector(const ChessboardCorners& corners,
                                                       const Correspondence& correspondence);

}  // namespace bodyscan
