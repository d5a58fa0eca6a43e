#include "pipeline/capture_check/frame_check.hpp"

#include "pipeline/decode/response.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bodyscan {
namespace {

constexpr double samples_wanted = 20'000;
constexpr float lit_light = 0.01F;         // white minus black, linear
constexpr double least_lit_share = 0.002;  // of the samples
constexpr double noise_sigmas = 5;
constexpr float clipped_light = 0.985F;
constexpr double most_clipped = 0.3;   // of the lit samples
constexpr double outside = 0.25;       // beyond black or white, in units of white minus black
constexpr double most_outside = 0.05;  // of the lit samples
constexpr double repeated = 0.03;      // mean difference, in units of white minus black
constexpr double unresolved = 0.06;    // stripes of less contrast do not differ from their inverse
constexpr double no_complement = 0.2;  // see complement_error

}  // namespace

FrameCheck::FrameCheck(std::vector<Pattern> patterns, const ToneResponse& response)
    : patterns_(std::move(patterns)), response_(response), samples_(patterns_.size()) {}

FrameCheck::Samples FrameCheck::sample(const Luma& photograph) {
  return std::visit(
      [&](const auto& image) {
        using Pixel = std::remove_cvref_t<decltype(image(0, 0))>;
        if (linear_.empty())
          for (const std::uint16_t value : linear_table(response_, 8 * static_cast<int>(sizeof(Pixel))))
            linear_.push_back(static_cast<float>(value) / linear_full_scale);
        const auto area = static_cast<double>(image.size().area());
        const int step = std::max(1, static_cast<int>(std::sqrt(area / samples_wanted)));
        Samples samples;
        for (int y = step / 2; y < image.height(); y += step)
          for (int x = step / 2; x < image.width(); x += step) samples.push_back(linear_.at(image(x, y)));
        return samples;
      },
      photograph);
}

std::optional<FrameFault> FrameCheck::check(int index, const Luma& photograph) {
  const Samples samples = sample(photograph);
  std::optional<FrameFault> fault;
  if (samples == last_) {
    fault = FrameFault{"the same picture as the shot before", {index}};
  } else if (index == 1) {
    fault = check_black(samples);
  } else if (index > 1) {
    fault = check_pattern(index, samples);
  }
  last_ = samples;
  if (!fault) samples_.at(static_cast<std::size_t>(index)) = samples;
  return fault;
}

std::optional<FrameFault> FrameCheck::check_black(const Samples& black) {
  const Samples& white = samples_[0];
  lit_.clear();
  light_ = 0;
  std::size_t darker = 0;
  std::size_t clipped = 0;
  for (std::size_t i = 0; i < black.size(); ++i) {
    const float light = white[i] - black[i];
    if (light < -lit_light) ++darker;
    if (light < lit_light) continue;
    lit_.push_back(i);
    light_ += light;
    if (white[i] >= clipped_light) ++clipped;
  }
  // Noise makes as many samples darker as brighter.
  const double brighter = static_cast<double>(lit_.size()) - static_cast<double>(darker);
  const double chance = noise_sigmas * std::sqrt(static_cast<double>(lit_.size() + darker));
  const double least = std::max(least_lit_share * static_cast<double>(black.size()), chance);
  if (brighter < -least) return FrameFault{"white is darker than black", {0, 1}};
  if (brighter < least) {
    // Black may be white's picture once more, or there is no light in either.
    black_doubted_ = !black_doubted_;
    const char* reason = "white and black show the same: the projector's light is not seen";
    return FrameFault{reason, black_doubted_ ? std::vector{1} : std::vector{0, 1}};
  }
  if (static_cast<double>(clipped) > most_clipped * static_cast<double>(lit_.size()))
    return FrameFault{"over-exposed", {0, 1}};
  return std::nullopt;
}

std::optional<FrameFault> FrameCheck::check_pattern(int index, const Samples& samples) const {
  const Samples& white = samples_[0];
  const Samples& black = samples_[1];
  std::size_t beyond = 0;
  for (const std::size_t i : lit_) {
    const double light = white[i] - black[i];
    const double share = (samples[i] - black[i]) / light;
    if (share < -outside || share > 1 + outside) ++beyond;
  }
  if (static_cast<double>(beyond) > most_outside * static_cast<double>(lit_.size()))
    return FrameFault{"another exposure than white's and black's", {index}};
  if (!last_.empty() && difference(samples, last_) < repeated && stripe_contrast(samples) > unresolved)
    return FrameFault{"the same picture as the shot before", {index}};
  const Pattern& pattern = patterns_[static_cast<std::size_t>(index)];
  const Samples& before = samples_[static_cast<std::size_t>(index) - 1];
  if (pattern.inverted && !before.empty() && complement_error(before, samples) > no_complement)
    return FrameFault{"not the complement of its pattern", {index - 1, index}};
  return std::nullopt;
}

double FrameCheck::difference(const Samples& a, const Samples& b) const {
  double sum = 0;
  for (const std::size_t i : lit_) sum += std::abs(a[i] - b[i]);
  return sum / light_;
}

double FrameCheck::stripe_contrast(const Samples& samples) const {
  double sum = 0;
  for (const std::size_t i : lit_) sum += std::abs(2 * samples[i] - samples_[0][i] - samples_[1][i]);
  return sum / light_;
}

double FrameCheck::complement_error(const Samples& pattern, const Samples& inverse) const {
  double sum = 0;
  for (const std::size_t i : lit_) sum += std::abs(pattern[i] + inverse[i] - samples_[0][i] - samples_[1][i]);
  return sum / light_;
}

}  // namespace bodyscan
