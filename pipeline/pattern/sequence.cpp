#include "pipeline/pattern/sequence.hpp"

#include <bit>

namespace bodyscan {

std::string describe(const Pattern& pattern) {
  if (pattern.kind == PatternKind::white) return "white";
  if (pattern.kind == PatternKind::black) return "black";
  const std::string axis = pattern.axis == Axis::row ? "row" : "column";
  if (pattern.kind == PatternKind::phase)
    return "phase " + axis + " step " + std::to_string(pattern.step) + " of " +
           std::to_string(pattern.steps) + " (period " + std::to_string(pattern.period_px) + ")";
  return "gray " + axis + " bit " + std::to_string(pattern.bit) + (pattern.inverted ? " inverted" : "");
}

Expected<void> PhaseCode::check() const {
  const auto refuse = [](const std::string& what) { return tl::unexpected(Error{ErrorKind::usage, what}); };
  if (period_px < 3 || period_px > max_period)
    return refuse("a phase's period must lie in 3 to " + std::to_string(max_period));
  if (steps < 3 || period_px % steps != 0)
    return refuse("phase steps must be 3 or more and divide the period");
  if (finest_bit < 0 || finest_bit > max_finest_bit || 1 << finest_bit >= period_px)
    return refuse(
        "beside phase steps the finest Gray bit must be 0, 1 or 2, its cells smaller than the period");
  return {};
}

int gray_bits(int count) {
  return count > 1 ? std::bit_width(static_cast<unsigned>(count - 1)) : 0;
}

Expected<PatternSequence> make_sequence(Size projector, const SequenceOptions& options) {
  constexpr int max_side = 1 << 15;
  if (projector.width < 2 || projector.height < 2 || projector.width > max_side ||
      projector.height > max_side)
    return tl::unexpected(Error{ErrorKind::usage, "projector size must lie in 2 x 2 to 32768 x 32768"});
  if (!options.rows && !options.columns)
    return tl::unexpected(Error{ErrorKind::usage, "a sequence needs rows, columns or both"});

  if (options.phase) {
    if (auto checked = options.phase->check(); !checked) return tl::unexpected(checked.error());
    const int least_bits = options.phase->finest_bit + 2;
    if ((options.rows && gray_bits(projector.height) < least_bits) ||
        (options.columns && gray_bits(projector.width) < least_bits))
      return tl::unexpected(Error{ErrorKind::usage, "the projector is too small for the phase code"});
  }

  PatternSequence sequence{projector, {{.kind = PatternKind::white}, {.kind = PatternKind::black}}};
  const bool inverses = options.inverses && !options.phase;
  const auto append = [&](Axis axis, int count) {
    const int steps = options.phase ? options.phase->steps : 0;
    for (int step = 0; step < steps; ++step)
      sequence.patterns.push_back({.kind = PatternKind::phase,
                                   .axis = axis,
                                   .period_px = options.phase->period_px,
                                   .step = step,
                                   .steps = steps});
    const int finest = options.phase ? options.phase->finest_bit : 0;
    for (int bit = gray_bits(count) - 1; bit >= finest; --bit) {
      sequence.patterns.push_back({PatternKind::gray, axis, bit, false});
      if (inverses) sequence.patterns.push_back({PatternKind::gray, axis, bit, true});
    }
  };
  if (options.rows) append(Axis::row, projector.height);
  if (options.columns) append(Axis::column, projector.width);
  return sequence;
}

bool pattern_is_white(const Pattern& pattern, unsigned index) {
  if (pattern.kind == PatternKind::phase) {
    const auto period = static_cast<unsigned>(pattern.period_px);
    const auto shift = static_cast<unsigned>(pattern.step * (pattern.period_px / pattern.steps));
    return (index + period - shift) % period < period / 2;
  }
  return (((gray_code(index) >> pattern.bit) & 1U) != 0) != pattern.inverted;
}

GrayImage8 render_pattern(const Pattern& pattern, Size projector) {
  if (pattern.kind == PatternKind::white || pattern.kind == PatternKind::black)
    return {projector, static_cast<std::uint8_t>(pattern.kind == PatternKind::white ? 255 : 0)};
  GrayImage8 image(projector);
  for (int y = 0; y < projector.height; ++y) {
    for (int x = 0; x < projector.width; ++x) {
      const int index = pattern.axis == Axis::row ? y : x;
      image(x, y) = pattern_is_white(pattern, static_cast<unsigned>(index)) ? 255 : 0;
    }
  }
  return image;
}

}  // namespace bodyscan
