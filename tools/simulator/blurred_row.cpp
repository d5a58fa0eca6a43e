#include "tools/simulator/blurred_row.hpp"

#include "tools/simulator/box_blur.hpp"

namespace bodyscan::simulator {

BlurredRow::BlurredRow(const std::vector<float>& pixels, double defocus, double scattered) {
  const auto blurred = [&](double sigma) {
    return BoxBlur(sigma, static_cast<int>(samples_per_px), static_cast<int>(margin)).blur(pixels);
  };
  const std::vector<float> sharp = blurred(defocus);
  const std::vector<float> soft = scattered > defocus ? blurred(scattered) : sharp;
  table_.reserve(sharp.size());
  for (std::size_t i = 0; i < sharp.size(); ++i) table_.push_back({sharp[i], soft[i] - sharp[i]});
}

}  // namespace bodyscan::simulator
