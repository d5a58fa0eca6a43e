#pragma once

#include "tools/evaluate/statistics.hpp"
#include "tools/evaluate/truth.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace bodyscan {

// How far every point of a model lies from the true surface, and the pixel that sees it.
struct Deviations {
  std::vector<float> distance;      // mm, signed: positive on the camera's side of the surface
  std::vector<std::int32_t> pixel;  // y * width + x of the rounded pixel, -1 outside the picture
};

// Within `tangent_limit` of the tangent plane of the true point at its pixel the distance to that plane
// counts; beyond it, or where the pixel has no truth, the exact distance to the true mesh.
inline constexpr double tangent_limit_mm = 0.2;

// Points behind the camera are as far off as the mesh is.
Deviations measure_deviations(const Truth& truth, std::span<const Point3f> points);

// A pixel is complete when a point that rounds to it lies within this distance of the true surface; a point
// beyond it is counted as wrong.
inline constexpr double wrong_mm = 1.0;

struct Coverage {
  std::size_t reachable = 0;  // pixels
  std::size_t covered = 0;    // of those, complete
  [[nodiscard]] double completeness() const {
    return reachable == 0 ? 0 : static_cast<double>(covered) / static_cast<double>(reachable);
  }
};

Coverage measure_coverage(const Truth& truth, const Deviations& deviations);

// Share of all points farther off than `wrong_mm`.
double share_wrong(const Deviations& deviations);

}  // namespace bodyscan
