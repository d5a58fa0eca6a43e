#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/base/image.hpp"

#include <optional>
#include <string>
#include <vector>

namespace bodyscan {

// The projector coordinate that stripes count: the row (changes downwards) or the column.
enum class Axis { row, column };

enum class PatternKind { white, black, gray, phase };

// One projected picture.
struct Pattern {
  PatternKind kind = PatternKind::white;
  Axis axis = Axis::row;  // gray and phase
  int bit = 0;            // gray only; 0 is the finest
  bool inverted = false;  // gray only; the complement picture
  int period_px = 0;      // phase only; rows or columns from one stripe to the next, half of them lit
  int step = 0;           // phase only; 0 to steps - 1
  int steps = 0;          // phase only; each shifts the stripes by period_px / steps

  friend bool operator==(const Pattern&, const Pattern&) = default;
};

// "white", "gray row bit 9 inverted", "phase row step 3 of 5 (period 5)"; for messages, steps counted from 0.
std::string describe(const Pattern& pattern);

// A coarse Gray code, whose cells are 2^finest_bit rows, and fine stripes that are shifted through one period
// (Guehring 2001, "Dense 3-D surface acquisition by structured light using off-the-shelf components"). A cell
// is smaller than the period, so that the phase says on which side of a cell's edge a pixel lies.
struct PhaseCode {
  int period_px = 5;
  int steps = 5;
  int finest_bit = 2;

  [[nodiscard]] constexpr int lit_px() const { return period_px / 2; }  // of a period

  static constexpr int max_period = 64;
  static constexpr int max_finest_bit = 2;

  [[nodiscard]] Expected<void> check() const;

  friend bool operator==(const PhaseCode&, const PhaseCode&) = default;
};

struct SequenceOptions {
  bool rows = true;
  bool columns = false;
  bool inverses = true;                 // each bit is followed by its complement; not with a phase code
  std::optional<PhaseCode> phase = {};  // instead of the finest bits
};

// 15 pictures for up to 1024 rows.
constexpr SequenceOptions fast_sequence{
    .rows = true, .columns = false, .inverses = false, .phase = PhaseCode{}};

struct PatternSequence {
  Size projector;
  std::vector<Pattern> patterns;
};

// The projector's rows or columns.
constexpr int count_along(Axis axis, Size projector) {
  return axis == Axis::row ? projector.height : projector.width;
}

// Number of Gray-code bits for `count` rows or columns: ceil(log2 count).
int gray_bits(int count);

constexpr unsigned gray_code(unsigned value) {
  return value ^ (value >> 1);
}

// The thesis's order: white, black, then bit by bit, coarsest first, rows before columns. With a phase code
// each axis starts with its steps.
Expected<PatternSequence> make_sequence(Size projector, const SequenceOptions& options = {});

// The picture the projector shows, 0 or 255 a pixel.
GrayImage8 render_pattern(const Pattern& pattern, Size projector);

// Whether the pattern is white at a row or column index (gray and phase). A phase pattern is white where
// (index - step * period_px / steps) mod period_px < period_px / 2, rounded down.
bool pattern_is_white(const Pattern& pattern, unsigned index);

}  // namespace bodyscan
