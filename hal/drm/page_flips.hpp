#pragma once

#include "hal/drm/drm_device.hpp"

#include <cstdint>
#include <map>

namespace bodyscan {

// The page-flip events of a card, of all its CRTCs.
class PageFlips {
 public:
  explicit PageFlips(const DrmDevice& device) : device_(device) {}
  PageFlips(const PageFlips&) = delete;
  PageFlips& operator=(const PageFlips&) = delete;
  ~PageFlips() = default;

  // To be called before a flip is committed: forgets what came late from an earlier one.
  void expect(std::uint32_t crtc);
  // The time of the flip (us, CLOCK_MONOTONIC); an error where none came until `until_us`.
  Expected<std::int64_t> wait(std::uint32_t crtc, std::int64_t until_us);
  // What a commit must carry for its event to arrive here.
  [[nodiscard]] void* event_tag() { return this; }

 private:
  enum class Arrival { event, nothing, failure };

  Arrival read_events(std::int64_t until_us);
  static void on_flip(int fd, unsigned sequence, unsigned seconds, unsigned microseconds, unsigned crtc,
                      void* flips);

  const DrmDevice& device_;
  std::map<std::uint32_t, std::int64_t> times_us_;  // by CRTC
};

}  // namespace bodyscan
