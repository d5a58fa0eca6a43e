#include "hal/replay/sequence_check.hpp"

#include <algorithm>

namespace bodyscan {
namespace {

// The patterns of one axis.
class AxisFrames {
 public:
  AxisFrames(const std::vector<ManifestFrame>& frames, Axis axis, Size projector)
      : axis_(axis), bits_(gray_bits(count_along(axis, projector))) {
    for (const ManifestFrame& frame : frames) {
      const Pattern& pattern = frame.pattern;
      if (pattern.kind != PatternKind::gray && pattern.kind != PatternKind::phase) continue;
      if (pattern.axis == axis) patterns_.push_back(pattern);
    }
  }

  [[nodiscard]] Expected<void> check() const {
    if (patterns_.empty()) return {};
    const auto phase = std::ranges::find(patterns_, PatternKind::phase, &Pattern::kind);
    if (phase != patterns_.end()) return check_phase(*phase).and_then([&] { return check_coarse(*phase); });
    const bool inverses = std::ranges::any_of(patterns_, &Pattern::inverted);
    for (int bit = bits_ - 1; bit >= 0; --bit) {
      for (const bool inverted : {false, true}) {
        if (inverted && !inverses) continue;
        const Pattern pattern{PatternKind::gray, axis_, bit, inverted};
        if (!shown(pattern)) return missing(pattern, inverted ? " (other inverses are there)" : "");
      }
    }
    return {};
  }

 private:
  [[nodiscard]] bool shown(const Pattern& pattern) const {
    return std::ranges::find(patterns_, pattern) != patterns_.end();
  }

  [[nodiscard]] static Expected<void> missing(const Pattern& pattern, const std::string& besides = "") {
    return input_error("frames: " + describe(pattern) + " is missing" + besides);
  }

  // Every step of one period.
  [[nodiscard]] Expected<void> check_phase(Pattern phase) const {
    for (const Pattern& pattern : patterns_)
      if (pattern.kind == PatternKind::phase &&
          (pattern.period_px != phase.period_px || pattern.steps != phase.steps))
        return input_error("frames: " + describe(pattern) + " does not go with " + describe(phase));
    for (phase.step = 0; phase.step < phase.steps; ++phase.step)
      if (!shown(phase)) return missing(phase);
    return {};
  }

  // No gap from the coarsest bit to one whose stripes are narrower than the period, and no inverses.
  [[nodiscard]] Expected<void> check_coarse(const Pattern& phase) const {
    int finest = bits_;
    for (const Pattern& pattern : patterns_) {
      if (pattern.kind != PatternKind::gray) continue;
      if (pattern.inverted)
        return input_error("frames: " + describe(pattern) + " beside phase steps, which need no inverses");
      finest = std::min(finest, pattern.bit);
    }
    finest = std::min({finest, std::max(0, bits_ - 2), PhaseCode::max_finest_bit});
    while (finest > 0 && 1 << finest >= phase.period_px) --finest;
    for (int bit = bits_ - 1; bit >= finest; --bit) {
      const Pattern pattern{PatternKind::gray, axis_, bit, false};
      if (!shown(pattern)) return missing(pattern);
    }
    return {};
  }

  Axis axis_;
  int bits_;
  std::vector<Pattern> patterns_;
};

}  // namespace

Expected<void> check_sequence(const std::vector<ManifestFrame>& frames, Size projector) {
  for (const PatternKind kind : {PatternKind::white, PatternKind::black})
    if (std::ranges::none_of(frames, [&](const ManifestFrame& frame) { return frame.pattern.kind == kind; }))
      return input_error("frames: " + describe({.kind = kind}) + " is missing");
  for (const Axis axis : {Axis::row, Axis::column})
    if (auto complete = AxisFrames(frames, axis, projector).check(); !complete) return complete;
  if (frames.size() <= 2) return input_error("frames: there is no gray pattern");
  return {};
}

}  // namespace bodyscan
