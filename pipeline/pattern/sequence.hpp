#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/base/image.hpp"

#include <string>
#include <vector>

namespace bodyscan {

// The projector coordinate that a Gray code counts: the row (changes downwards) or the column.
enum class Axis { row, column };

enum class PatternKind { white, black, gray };

// One projected picture.
struct Pattern {
  PatternKind kind = PatternKind::white;
  Axis axis = Axis::row;  // gray only
  int bit = 0;            // gray only; 0 is the finest
  bool inverted = false;  // gray only; the complement picture

  friend bool operator==(const Pattern&, const Pattern&) = default;
};

// "white", "gray row bit 9 inverted"; for messages.
std::string describe(const Pattern& pattern);

struct SequenceOptions {
  bool rows = true;
  bool columns = false;
  bool inverses = true;  // each bit is followed by its complement
};

struct PatternSequence {
  Size projector;
  std::vector<Pattern> patterns;
};

// Number of Gray-code bits for `count` rows or columns: ceil(log2 count).
int gray_bits(int count);

constexpr unsigned gray_code(unsigned value) {
  return value ^ (value >> 1);
}

// The thesis's order: white, black, then bit by bit, coarsest first, rows before columns.
Expected<PatternSequence> make_sequence(Size projector, const SequenceOptions& options = {});

// The picture the projector shows, 0 or 255 a pixel.
GrayImage8 render_pattern(const Pattern& pattern, Size projector);

// Whether the pattern is white at a row or column index (gray patterns only).
bool pattern_is_white(const Pattern& pattern, unsigned index);

}  // namespace bodyscan
