#pragma once

#include "pipeline/capture_check/motion.hpp"
#include "pipeline/image/frame.hpp"
#include "pipeline/image/tone_response.hpp"
#include "pipeline/pattern/sequence.hpp"

#include <map>
#include <vector>

namespace bodyscan {

// What moved during a sequence that ends on white once more.
struct SequenceMotion {
  double largest_px = 0;  // of any photograph against the last white, px of the photograph
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  // where the most moved, px
  std::vector<double> by_pattern_px;             // against the last white; empty where it is not known
};

// Follows the subject through a sequence. Light adds up: a pattern and its inverse together show the subject
// as white and black do, whatever the stripes, so each such pair is compared with the first. Keeps one
// reduced picture and a number a tile and pair.
class MotionWatch {
 public:
  explicit MotionWatch(std::vector<Pattern> patterns, const ToneResponse& response = {});

  // A photograph of pattern `index`, in the sequence's order; index patterns.size() is the white at the end.
  void look(int index, const Luma& photograph);

  [[nodiscard]] SequenceMotion motion() const;

 private:
  std::vector<Pattern> patterns_;
  ToneResponse response_;
  FloatImage white_;
  FloatImage reference_;  // white and black
  FloatImage held_;       // a pattern until its inverse comes
  int factor_ = 1;
  std::map<int, std::vector<TileMotion>> moved_;  // against the first unit, by a unit's first pattern
  std::vector<TileMotion> moved_at_end_;
};

}  // namespace bodyscan
