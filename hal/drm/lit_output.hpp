#pragma once

#include "hal/drm/page_flips.hpp"
#include "hal/drm/scanout_buffer.hpp"
#include "hal/drm/scanout_path.hpp"
#include "pipeline/base/image.hpp"

#include <array>
#include <cstdint>
#include <memory>

#include <xf86drmMode.h>

namespace bodyscan {

// A connector that is lit in one mode, with two buffers to draw in; switched off on destruction.
class LitOutput {
 public:
  // Black. Whatever lit the connector before is replaced.
  static Expected<std::unique_ptr<LitOutput>> light(const DrmDevice& device, PageFlips& flips,
                                                    const ScanoutPath& path, const drmModeModeInfo& timing);
  LitOutput(const LitOutput&) = delete;
  LitOutput& operator=(const LitOutput&) = delete;
  ~LitOutput();

  [[nodiscard]] std::uint32_t crtc() const { return path_.crtc; }
  // False where another program, or the kernel, switched the CRTC off or to another mode.
  [[nodiscard]] bool is_lit() const;
  [[nodiscard]] const drmModeModeInfo& timing() const { return timing_; }
  // Returns the time of the page flip (us, CLOCK_MONOTONIC), or an error after a second without one.
  Expected<std::int64_t> show(const GrayImage8& picture);

 private:
  LitOutput(const DrmDevice& device, PageFlips& flips, const ScanoutPath& path, const drmModeModeInfo& timing,
            std::array<ScanoutBuffer, 2> buffers)
      : device_(device), flips_(flips), path_(path), timing_(timing), buffers_(std::move(buffers)) {}

  Expected<void> set_mode();
  Expected<void> commit_flip(std::uint32_t framebuffer, std::int64_t until_us);

  const DrmDevice& device_;
  PageFlips& flips_;
  ScanoutPath path_;
  drmModeModeInfo timing_;
  std::array<ScanoutBuffer, 2> buffers_;
  std::size_t front_ = 0;
};

}  // namespace bodyscan
