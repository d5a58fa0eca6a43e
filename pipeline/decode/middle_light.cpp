#include "pipeline/decode/middle_light.hpp"

#include "pipeline/base/instruction_set.hpp"
#include "pipeline/base/parallel.hpp"
#include "pipeline/decode/response.hpp"

namespace bodyscan {
namespace {

// Of two pictures; a mean that contradicts white and black must not overflow differences.
constexpr float brightest = 2 * linear_full_scale;

struct Mix {
  // sum += weight (mean + unlit contrast - sum), `unlit` the share of white that the mean lacks, times two.
  BODYSCAN_KERNEL void run(int width, float weight, float unlit, const std::uint16_t* mean,
                           const std::uint16_t* contrast, std::uint16_t* sum) {
    BODYSCAN_VECTORIZE
    for (int x = 0; x < width; ++x) {
      const float before = static_cast<float>(sum[x]);
      const float measured = static_cast<float>(mean[x]) + unlit * static_cast<float>(contrast[x]);
      const float mixed = before + weight * (measured - before) + 0.5F;
      sum[x] = static_cast<std::uint16_t>(mixed < brightest ? mixed : brightest);
    }
  }
};

}  // namespace

MiddleLight::MiddleLight(const Luma& white, const Luma& black, std::span<const std::uint16_t> linear)
    : twice_(size_of(white)) {
  std::visit(
      [&](const auto& w) {
        const auto& b = std::get<std::decay_t<decltype(w)>>(black);
        for (std::size_t i = 0; i < twice_.size().area(); ++i)
          twice_.data()[i] = static_cast<std::uint16_t>(linear[w.data()[i]] + linear[b.data()[i]]);
      },
      white);
}

void MiddleLight::refine(PhasePlanes& steps, const Image<std::uint16_t>& contrast) {
  const PhaseCode& code = steps.code();
  const float lit = static_cast<float>(code.lit_px()) / static_cast<float>(code.period_px);
  const float unlit = 1 - 2 * lit;
  // Of four times the mean's variance and unlit (white - black).
  const float measured = 4 / static_cast<float>(code.steps) + 2 * unlit * unlit;
  const float weight = variance_ / (variance_ + measured);
  const Image<std::uint16_t> mean = steps.take_twice_mean();
  parallel_for(0, twice_.height(), 64, [&](int first, int last) {
    for (int y = first; y < last; ++y)
      run_kernel<Mix>(twice_.width(), weight, unlit, mean.row(y), contrast.row(y), twice_.row(y));
  });
  variance_ *= 1 - weight;
}

}  // namespace bodyscan
