#include "pipeline/capture_check/motion_watch.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace bodyscan {
namespace {

void add(FloatImage& sum, const FloatImage& other) {
  for (std::size_t i = 0; i < sum.pixels().size(); ++i) sum.pixels()[i] += other.pixels()[i];
}

// What moved from one to the other, where both are known; both against the same picture.
std::vector<TileMotion> between(const std::vector<TileMotion>& from, const std::vector<TileMotion>& to) {
  std::vector<TileMotion> result;
  for (const TileMotion& tile : to) {
    const auto same = std::ranges::find(from, tile.at, &TileMotion::at);
    if (same != from.end()) result.push_back({tile.at, tile.moved - same->moved});
  }
  return result;
}

}  // namespace

MotionWatch::MotionWatch(std::vector<Pattern> patterns, const ToneResponse& response)
    : patterns_(std::move(patterns)), response_(response) {}

void MotionWatch::look(int index, const Luma& photograph) {
  if (index == 0) factor_ = motion_factor(size_of(photograph));
  const bool at_end = index == static_cast<int>(patterns_.size());
  const Pattern& pattern = patterns_[at_end ? 0 : static_cast<std::size_t>(index)];
  const bool has_inverse = index + 1 < static_cast<int>(patterns_.size()) &&
                           patterns_[static_cast<std::size_t>(index) + 1].inverted;
  const bool white_or_black = pattern.kind == PatternKind::white || pattern.kind == PatternKind::black;
  if (!white_or_black && !pattern.inverted && !has_inverse) return;
  FloatImage view = reduce(photograph, factor_, response_);
  if (at_end) {
    moved_at_end_ = motion_between(white_, view, factor_);
  } else if (index == 0) {
    white_ = std::move(view);
  } else if (pattern.kind == PatternKind::black) {
    reference_ = white_.clone();
    add(reference_, view);
    moved_.clear();
  } else if (pattern.inverted) {
    add(held_, view);
    moved_[index - 1] = motion_between(reference_, held_, factor_);
  } else {
    held_ = std::move(view);
  }
}

SequenceMotion MotionWatch::motion() const {
  SequenceMotion result;
  const auto note = [&](const std::vector<TileMotion>& moved) {
    const double px = usual_motion_px(moved);
    if (px > result.largest_px) {
      result.largest_px = px;
      result.at = std::ranges::max_element(moved, {}, [](const TileMotion& tile) {
                    return tile.moved.squaredNorm();
                  })->at;
    }
    return px;
  };
  const double start_px = note(moved_at_end_);
  bool known = true;
  for (std::size_t i = 0; i < patterns_.size(); ++i) {
    const auto unit = moved_.find(static_cast<int>(patterns_[i].inverted ? i - 1 : i));
    if (i > 1 && unit == moved_.end()) known = false;
    result.by_pattern_px.push_back(unit == moved_.end() ? start_px
                                                        : note(between(unit->second, moved_at_end_)));
  }
  if (!known) result.by_pattern_px.clear();
  return result;
}

}  // namespace bodyscan
