#include "pipeline/decode/illumination.hpp"

#include "pipeline/base/parallel.hpp"

#include <atomic>
#include <limits>

namespace bodyscan {
namespace {

template <class Pixel>
Expected<Illumination> measure(const Image<Pixel>& white, const Image<Pixel>& black, float min_contrast,
                               const std::uint16_t* linear) {
  constexpr float levels = static_cast<float>(std::numeric_limits<Pixel>::max()) / 255;
  const int threshold = static_cast<int>(min_contrast * levels + 0.5F);
  Illumination light{Image<std::uint16_t>(white.size()), 0};
  std::atomic<std::size_t> lit = 0;
  std::atomic<long> excess = 0;
  parallel_for(0, white.height(), 64, [&](int begin, int end) {
    std::size_t lit_here = 0;
    long excess_here = 0;
    for (int y = begin; y < end; ++y) {
      const Pixel* w = white.row(y);
      const Pixel* b = black.row(y);
      std::uint16_t* contrast = light.contrast.row(y);
      for (int x = 0; x < white.width(); ++x) {
        const bool bright = w[x] - b[x] >= threshold && linear[w[x]] > linear[b[x]];
        contrast[x] = bright ? static_cast<std::uint16_t>(linear[w[x]] - linear[b[x]]) : std::uint16_t{0};
        lit_here += bright;
        excess_here += w[x] - b[x];
      }
    }
    lit += lit_here;
    excess += excess_here;
  });
  light.pixels_lit = lit;
  if (excess < 0) return input_error("the white frame is darker than the black one");
  if (light.pixels_lit == 0)
    return input_error("nothing is lit: no pixel of the white frame exceeds the black one");
  return light;
}

}  // namespace

Expected<Illumination> measure_illumination(const Luma& white, const Luma& black, float min_contrast,
                                            std::span<const std::uint16_t> linear) {
  return std::visit(
      [&](const auto& w) {
        return measure(w, std::get<std::decay_t<decltype(w)>>(black), min_contrast, linear.data());
      },
      white);
}

}  // namespace bodyscan
