#pragma once

#include "app/scan/shot_list.hpp"
#include "hal/camera.hpp"
#include "pipeline/base/error.hpp"
#include "pipeline/capture_check/frame_check.hpp"
#include "pipeline/capture_check/motion_watch.hpp"
#include "pipeline/decode/decoder.hpp"
#include "pipeline/pattern/sequence.hpp"

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace bodyscan {

// What a sequence of shots gave.
struct DecodedShots {
  Correspondence correspondence;
  SequenceMotion motion;
};

// Works on photographs behind the camera's back: a thread of its own decompresses each, checks that it is of
// its pattern, tells the shot list, and feeds the decoder in the sequence's order. Keeps the photographs as
// the camera gave them; what is decoded from them has a fixed size.
class LiveDecoder {
 public:
  // The photographs must be of `camera`'s size. Indices count the sequence's patterns; the last index more is
  // the white at the end.
  LiveDecoder(PatternSequence sequence, Size camera, const DecodeOptions& options);
  LiveDecoder(const LiveDecoder&) = delete;
  LiveDecoder& operator=(const LiveDecoder&) = delete;
  ~LiveDecoder();

  [[nodiscard]] int pattern_count() const { return static_cast<int>(photographs_.size()); }

  // Until `finish` returns, photographs are judged for this list, which is of the patterns `wanted`; of
  // others the photographs that there are serve again.
  void begin(ShotList& list, const std::vector<int>& wanted);
  void hand_over(const PlannedShot& shot, Photograph photograph);
  // After the list's last shot: waits for what is still to be done.
  Expected<DecodedShots> finish();
  // Instead of `finish`, where the list was not shot to its end: forgets what was handed over. The list is
  // not used from then on.
  void abandon();
  // Whether every pattern has a photograph.
  [[nodiscard]] bool complete() const;

  // The photograph that was accepted of a pattern.
  [[nodiscard]] const Photograph& photograph(int pattern) const {
    return photographs_[static_cast<std::size_t>(pattern)];
  }

 private:
  struct Shot {
    PlannedShot planned;
    Photograph photograph;
  };

  void work();
  void stop();
  Expected<void> judge(const Shot& shot);
  Expected<void> use_ready();
  Expected<void> use(int pattern);
  [[nodiscard]] int last_of_unit(int pattern) const;

  PatternSequence sequence_;
  Size camera_;
  DecodeOptions options_;
  ShotList* list_ = nullptr;

  // Of the thread.
  std::optional<FrameCheck> check_;
  std::optional<MotionWatch> motion_;
  std::optional<Decoder> decoder_;
  std::vector<Photograph> photographs_;
  std::vector<bool> accepted_;
  std::map<int, Luma> decompressed_;  // accepted, to be used soon
  int used_ = 0;                      // patterns that went into decoder and motion

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Shot> shots_;
  bool complete_ = false;  // no shot is to come
  std::thread thread_;
};

}  // namespace bodyscan
