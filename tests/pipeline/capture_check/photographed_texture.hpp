#pragma once

#include "pipeline/base/image.hpp"
#include "pipeline/image/frame.hpp"
#include "pipeline/pattern/sequence.hpp"

#include <random>
#include <vector>

#include <Eigen/Core>

namespace bodyscan {

inline constexpr Size texture_size{400, 300};  // of every photograph, px

// Smooth random brightness, 0.2 to 0.8, with waves of 16 to 60 px; `moved` is where its origin lies, px.
FloatImage texture(const Eigen::Vector2d& moved = Eigen::Vector2d::Zero(), Size size = texture_size);

// The same where it is when it has not moved.
const FloatImage& texture_at_rest();

struct ShotOptions {
  double exposure = 1;    // 1: white is well exposed
  double projector = 1;   // its light; 0: none
  double ambient = 0.02;  // light, of full scale at exposure 1
  double noise = 1;       // grey levels, standard deviation
  int blurred_bits = 0;   // so many of the finest bits are an even grey
};

// Photographs of a textured wall on which a projector of 64 x 48 shows patterns; every shot has noise of its
// own. sRGB, 8 bits.
class TexturedWall {
 public:
  // The wall stands there from now on.
  void move_to(const Eigen::Vector2d& moved) { albedo_ = texture(moved); }

  GrayImage8 shoot(const Pattern& pattern, const ShotOptions& options = {});

  static constexpr Size projector{64, 48};

 private:
  FloatImage albedo_ = texture_at_rest().clone();
  std::mt19937 random_{1};
};

// The patterns of TexturedWall's projector, in both axes, with white once more at the end.
std::vector<Pattern> patterns_of_wall(bool inverses);

}  // namespace bodyscan
