#include "pipeline/pattern/sequence.hpp"

#include <bit>

namespace bodyscan {

std::string describe(const Pattern& pattern) {
  if (pattern.kind == PatternKind::white) return "white";
  if (pattern.kind == PatternKind::black) return "black";
  return std::string("gray ") + (pattern.axis == Axis::row ? "row" : "column") + " bit " +
         std::to_string(pattern.bit) + (pattern.inverted ? " inverted" : "");
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

  PatternSequence sequence{projector, {{.kind = PatternKind::white}, {.kind = PatternKind::black}}};
  const auto append = [&](Axis axis, int count) {
    for (int bit = gray_bits(count) - 1; bit >= 0; --bit) {
      sequence.patterns.push_back({PatternKind::gray, axis, bit, false});
      if (options.inverses) sequence.patterns.push_back({PatternKind::gray, axis, bit, true});
    }
  };
  if (options.rows) append(Axis::row, projector.height);
  if (options.columns) append(Axis::column, projector.width);
  return sequence;
}

bool pattern_is_white(const Pattern& pattern, unsigned index) {
  return (((gray_code(index) >> pattern.bit) & 1U) != 0) != pattern.inverted;
}

GrayImage8 render_pattern(const Pattern& pattern, Size projector) {
  if (pattern.kind != PatternKind::gray)
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
