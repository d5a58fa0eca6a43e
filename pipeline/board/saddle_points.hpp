#pragma once

#include "pipeline/base/image.hpp"

#include <array>
#include <vector>

#include <Eigen/Core>

namespace bodyscan {

// A place where four squares of a chessboard may meet: brightness rises along one diagonal and falls along
// the other.
struct SaddlePoint {
  Eigen::Vector2d at;                    // px
  std::array<Eigen::Vector2d, 2> edges;  // unit directions of the two edges through it, 180 degrees open
  bool positive;                         // bright between edges[0] and edges[1] going by the smaller angle
  float strength;                        // 0.64 for four sharp, equally bright pairs of squares
};

struct SaddleOptions {
  float blur_px = 1.5F;       // Gaussian before derivatives
  float ring_px = 5;          // radius of the circle on which bright and dark must alternate
  float min_strength = 0.2F;  // of a saddle
  float min_deviation = 3;    // grey levels, standard deviation around it: less is noise
};

// Saddles of the smoothed image (determinant of the Hessian negative and extreme), relative to the local
// standard deviation, on whose circle brightness goes up and down twice, alike on opposite sides (Bennett and
// Lasenby 2014).
std::vector<SaddlePoint> find_saddle_points(const FloatImage& image, const SaddleOptions& options);

// Separable Gaussian; borders repeat.
FloatImage gaussian_blur(const FloatImage& image, float sigma_px);

}  // namespace bodyscan
