#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/base/image.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

namespace bodyscan {

struct ColorOptions {
  // Row-major 3x3 matrix that turns the camera's linear red, green, blue (black level subtracted) into linear
  // sRGB; none leaves the colours as the camera gives them.
  std::optional<std::array<double, 9>> correction;

  [[nodiscard]] Expected<void> check() const;
};

// The colour of every pixel under the projector's light alone: the white frame minus the black one, in linear
// light (sRGB transfer curve, IEC 61966-2-1), clipped to what sRGB holds. Exposure is left as it is. Borrows
// the two photographs.
class SurfaceColor {
 public:
  // `black` may be empty: then nothing is subtracted. Error: sizes differ, or a matrix that is not finite.
  [[nodiscard]] static Expected<SurfaceColor> create(const ColorImage8& white, const ColorImage8& black,
                                                     const ColorOptions& options = {});

  [[nodiscard]] Size size() const { return white_->size(); }
  // The colours of row y; `out` holds size().width pixels.
  void row(int y, Rgb8* out) const;
  [[nodiscard]] ColorImage8 image() const;

 private:
  static constexpr int levels = 1 << 14;  // linear light is counted in this many steps

  // The tables of the transfer curve.
  struct Curve {
    std::array<std::uint16_t, 256> linear;
    std::array<std::uint8_t, levels> encoded;
  };

  SurfaceColor() = default;
  static const Curve& curve();

  const ColorImage8* white_ = nullptr;
  const ColorImage8* black_ = nullptr;
  std::optional<std::array<float, 9>> correction_;
};

}  // namespace bodyscan
