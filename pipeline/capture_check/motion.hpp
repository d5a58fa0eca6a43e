#pragma once

#include "pipeline/base/image.hpp"
#include "pipeline/image/frame.hpp"
#include "pipeline/image/tone_response.hpp"

#include <vector>

#include <Eigen/Core>

namespace bodyscan {

// A photograph made smaller by averaging squares of `factor` pixels: linear light, full scale 1.
FloatImage reduce(const Luma& photograph, int factor, const ToneResponse& response = {});

// The factor that leaves pictures about a thousand pixels wide.
int motion_factor(Size photograph);

// How far what a tile shows has moved from one picture to another.
struct TileMotion {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();     // the tile's middle, px of the photograph
  Eigen::Vector2d moved = Eigen::Vector2d::Zero();  // px of the photograph
};

// Motion of every tile (32 reduced pixels a side) whose structure tells it to a tenth of a reduced pixel, by
// aligning brightness (Lucas and Kanade 1981, iterated). Along an edge nothing can be told: only the motion
// across it counts. What a body does it does together, so each tile has the median of its neighbours' motion.
// `photographs` were reduced by `factor`, both of one size.
std::vector<TileMotion> motion_between(const FloatImage& before, const FloatImage& after, int factor);

// What a few tiles that went wrong do not decide: the motion that nine of ten do not exceed, px. 0 without
// tiles.
double usual_motion_px(const std::vector<TileMotion>& tiles);

}  // namespace bodyscan
