#include "pipeline/surface/color.hpp"

#include "pipeline/base/parallel.hpp"
#include "pipeline/base/size_text.hpp"
#include "pipeline/image/srgb.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace bodyscan {

Expected<void> ColorOptions::check() const {
  if (!correction || std::ranges::all_of(*correction, [](double value) { return std::isfinite(value); })) {
    return {};
  }
  return tl::unexpected(Error{ErrorKind::usage, "color: correction: not finite"});
}

const SurfaceColor::Curve& SurfaceColor::curve() {
  static const Curve tables = [] {
    Curve curve{};
    for (std::size_t i = 0; i < curve.linear.size(); ++i) {
      const double linear = srgb_to_linear(static_cast<double>(i) / 255);
      curve.linear[i] = static_cast<std::uint16_t>(std::lround(linear * (levels - 1)));
    }
    for (std::size_t i = 0; i < curve.encoded.size(); ++i) {
      const double encoded = linear_to_srgb(static_cast<double>(i) / (levels - 1));
      curve.encoded[i] = static_cast<std::uint8_t>(std::lround(encoded * 255));
    }
    return curve;
  }();
  return tables;
}

Expected<SurfaceColor> SurfaceColor::create(const ColorImage8& white, const ColorImage8& black,
                                            const ColorOptions& options) {
  if (!black.empty() && black.size() != white.size()) {
    return input_error("black frame: " + text_of(black.size()) + " pixels, the white frame has " +
                       text_of(white.size()));
  }
  if (auto checked = options.check(); !checked) return tl::unexpected(checked.error());
  SurfaceColor color;
  color.white_ = &white;
  color.black_ = &black;
  if (options.correction) {
    color.correction_.emplace();
    std::ranges::transform(*options.correction, color.correction_->begin(),
                           [](double value) { return static_cast<float>(value); });
  }
  return color;
}

void SurfaceColor::row(int y, Rgb8* out) const {
  const Curve& tables = curve();
  const Rgb8* white = white_->row(y);
  const Rgb8* black = black_->empty() ? nullptr : black_->row(y);
  if (!black && !correction_) {
    std::copy_n(white, size().width, out);
    return;
  }
  for (int x = 0; x < size().width; ++x) {
    std::array<int, 3> linear;
    for (std::size_t i = 0; i < 3; ++i) {
      linear[i] = tables.linear[white[x][i]] - (black ? tables.linear[black[x][i]] : 0);
    }
    if (correction_) {
      const std::array<float, 9>& m = *correction_;
      const std::array<int, 3> in = linear;
      for (std::size_t i = 0; i < 3; ++i) {
        const float sum = m[3 * i] * static_cast<float>(in[0]) + m[3 * i + 1] * static_cast<float>(in[1]) +
                          m[3 * i + 2] * static_cast<float>(in[2]);
        linear[i] = static_cast<int>(std::clamp(sum + 0.5F, 0.F, static_cast<float>(levels - 1)));
      }
    }
    for (std::size_t i = 0; i < 3; ++i) {
      out[x][i] = tables.encoded[static_cast<std::size_t>(std::max(0, linear[i]))];
    }
  }
}

ColorImage8 SurfaceColor::image() const {
  ColorImage8 result(size());
  parallel_for(0, size().height, 32, [&](int first, int last) {
    for (int y = first; y < last; ++y) row(y, result.row(y));
  });
  return result;
}

}  // namespace bodyscan
