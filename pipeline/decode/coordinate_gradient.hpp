#pragma once

#include "pipeline/base/image.hpp"
#include "pipeline/decode/coordinate_rows.hpp"
#include "pipeline/decode/correspondence.hpp"

#include <cstdint>

namespace bodyscan {

// Every third camera row of an axis's correspondence: enough for what is measured over the whole picture.
struct SampledRows {
  static constexpr int step = 3;

  explicit SampledRows(Size camera);
  void measure(const CoordinateRows& rows);

  AxisCorrespondence values;  // row k: camera row step * k
};

// Projector px a camera px.
struct Gradient {
  float across = 0;
  float down = 0;
};

// Mean gradient of the coordinate over blocks of block_px x block_px camera pixels and their neighbours, from
// bright pixels: at a brightness edge the dark side's own coordinates are too noisy to differentiate.
class GradientMap {
 public:
  static constexpr int block_px = 32;

  GradientMap(const SampledRows& sampled, const Image<std::uint16_t>& contrast);

  // Columns of blocks; column bx covers camera columns from bx * block_px.
  [[nodiscard]] int columns() const { return blocks_.width(); }
  [[nodiscard]] const Gradient& of_block(int bx, int y) const { return blocks_(bx, y / block_px); }
  // Contrast from which a pixel counted.
  [[nodiscard]] std::uint16_t bright() const { return bright_; }
  // Camera pixels a projector pixel along the steeper image direction, median over the blocks; 0: not known.
  [[nodiscard]] float px_per_unit() const;

 private:
  std::uint16_t bright_;
  Image<Gradient> blocks_;
};

}  // namespace bodyscan
