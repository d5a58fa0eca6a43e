#pragma once

#include "pipeline/base/error.hpp"

#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace bodyscan {

// A shot to be taken of the pattern of that index.
struct PlannedShot {
  int pattern = 0;
  bool discard_first = false;  // one more before, to be thrown away
  int epoch = 0;               // refusals before it was taken from the list
};

// Which patterns are still to be shot. One thread shoots, another one judges what was shot; a photograph that
// is refused brings its pattern back, up to a number of attempts. A camera may deliver the picture of an
// earlier shot and be out of step from then on, so after a refusal one picture is thrown away, and a shot
// that was made meanwhile is made again.
class ShotList {
 public:
  // Patterns 0 to `patterns` - 1, in that order; only those of `wanted` where it is given.
  ShotList(int patterns, int attempts);
  ShotList(const std::vector<int>& wanted, int patterns, int attempts);

  // The next shot. While none is left but judgements are outstanding it waits for these, or not. Nothing once
  // everything is shot and accepted, or failed.
  std::optional<PlannedShot> next();
  std::optional<PlannedShot> next_without_waiting();
  // A shot that was taken from the list but not made. It comes in the patterns' order again.
  void put_back(const PlannedShot& shot);

  // Whether a shot was made before the last refusal and must be made again.
  [[nodiscard]] bool outdated(const PlannedShot& shot);
  void accept();
  // These patterns, none of which comes after the one judged, are shot again before what is left.
  void refuse(int judged, const std::vector<int>& again, const std::string& reason);
  void fail(const Error& error);

  // The error of a pattern that was refused too often, or of `fail`.
  [[nodiscard]] Expected<void> outcome();
  // Shots that were refused, with their reasons.
  [[nodiscard]] std::vector<std::string> refusals();

 private:
  std::optional<PlannedShot> take();
  void bring_back(const PlannedShot& shot);

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<PlannedShot> shots_;  // in the patterns' order
  std::vector<int> refused_;       // times, a pattern each
  int attempts_;
  int unjudged_ = 0;
  int epoch_ = 0;
  std::vector<std::string> refusals_;
  std::optional<Error> failure_;
};

}  // namespace bodyscan
