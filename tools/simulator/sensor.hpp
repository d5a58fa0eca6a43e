#pragma once

#include "pipeline/image/srgb.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace bodyscan::simulator {

// A camera's sensor: shot and read noise, then the sRGB curve in 8 bits. The noise is a function of seed,
// frame and pixel alone, so pictures do not depend on the number of threads.
class Sensor {
 public:
  // full_well 0: no noise.
  Sensor(double full_well, double read_noise, std::uint64_t seed, std::uint64_t frame);

  // Linear light (1 = full scale) at the pixel of this number to its three codes.
  [[nodiscard]] std::array<std::uint8_t, 3> expose(const std::array<float, 3>& light,
                                                   std::uint64_t pixel) const;

 private:
  [[nodiscard]] std::uint8_t code(float light, float gauss) const;

  float full_well_;
  float read_variance_;
  std::uint64_t key_;
  const std::vector<float>* gauss_;
  const std::vector<std::uint8_t>* codes_;
  std::vector<std::uint8_t> dark_;  // codes without light: most of a picture is
};

}  // namespace bodyscan::simulator
