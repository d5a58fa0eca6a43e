#pragma once

#include "pipeline/image/frame.hpp"
#include "pipeline/image/tone_response.hpp"
#include "pipeline/pattern/sequence.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace bodyscan {

// Why a photograph cannot be that of its pattern.
struct FrameFault {
  std::string reason;      // "the same picture as the shot before"
  std::vector<int> again;  // indices of the patterns to shoot again
};

// Looks at each photograph of a sequence as it comes, at some ten thousand pixels, and tells those that do
// not show their pattern: a camera that delivers an earlier shot's picture (its memory was not empty),
// another exposure, no light. Photographs come in the order in which they were taken; one that is taken again
// is given again.
class FrameCheck {
 public:
  // The sequence starts with white and black.
  explicit FrameCheck(std::vector<Pattern> patterns, const ToneResponse& response = {});

  // `index` counts patterns; all photographs of one size and depth. Nothing: it may be of that pattern.
  std::optional<FrameFault> check(int index, const Luma& photograph);

  // A photograph that is not used, whatever it shows.
  void skip(const Luma& photograph) { last_ = sample(photograph); }

  // The shot before the next was of the same pattern and thrown away: the next may look like it.
  void forget_shot_before() { last_.clear(); }

 private:
  using Samples = std::vector<float>;  // linear light, full scale 1

  Samples sample(const Luma& photograph);
  std::optional<FrameFault> check_black(const Samples& black);
  std::optional<FrameFault> check_pattern(int index, const Samples& samples) const;
  // Mean of |a - b| over the lit samples, in units of white minus black.
  [[nodiscard]] double difference(const Samples& a, const Samples& b) const;
  [[nodiscard]] double stripe_contrast(const Samples& samples) const;
  [[nodiscard]] double complement_error(const Samples& pattern, const Samples& inverse) const;

  std::vector<Pattern> patterns_;
  ToneResponse response_;
  std::vector<float> linear_;     // of every encoded value
  std::vector<Samples> samples_;  // accepted, a pattern each
  Samples last_;                  // of the shot before
  std::vector<std::size_t> lit_;  // indices of samples that the projector lights
  double light_ = 0;              // sum of white minus black over these
  bool black_doubted_ = false;
};

}  // namespace bodyscan
