#include "hal/drm/lit_output.hpp"

#include "hal/clock.hpp"
#include "hal/drm/atomic_request.hpp"
#include "hal/drm/kms_answers.hpp"
#include "pipeline/base/size_text.hpp"

#include <cerrno>
#include <cstring>
#include <utility>

#include <poll.h>

namespace bodyscan {
namespace {

constexpr std::int64_t flip_limit_us = 1'000'000;

tl::unexpected<Error> refused(const std::string& what, int error) {
  if (error == EACCES) return device_error("another program took over the displays");
  return device_error("the graphics card refused " + what + ": " + std::strerror(error));
}

bool same_timing(const drmModeModeInfo& a, const drmModeModeInfo& b) {
  return a.clock == b.clock && a.hdisplay == b.hdisplay && a.htotal == b.htotal && a.vdisplay == b.vdisplay &&
         a.vtotal == b.vtotal;
}

void set_picture(AtomicRequest& request, const KmsObject& plane, const ScanoutPath& path,
                 const ScanoutBuffer& buffer) {
  const auto width = static_cast<std::uint64_t>(buffer.size().width);
  const auto height = static_cast<std::uint64_t>(buffer.size().height);
  request.set(plane, "FB_ID", buffer.framebuffer());
  request.set(plane, "CRTC_ID", path.crtc);
  request.set(plane, "SRC_X", 0);
  request.set(plane, "SRC_Y", 0);
  request.set(plane, "SRC_W", width << 16);  // 16.16 fixed point
  request.set(plane, "SRC_H", height << 16);
  request.set(plane, "CRTC_X", 0);
  request.set(plane, "CRTC_Y", 0);
  request.set(plane, "CRTC_W", width);
  request.set(plane, "CRTC_H", height);
  request.set_if_there(plane, "rotation", DRM_MODE_ROTATE_0);
}

// Grey levels reach the display as they are drawn, whatever a desktop left behind (night light).
void clear_colour_tables(AtomicRequest& request, const KmsObject& crtc) {
  for (const char* table : {"DEGAMMA_LUT", "CTM", "GAMMA_LUT"}) request.set_if_there(crtc, table, 0);
}

}  // namespace

Expected<std::unique_ptr<LitOutput>> LitOutput::light(const DrmDevice& device, PageFlips& flips,
                                                      const ScanoutPath& path,
                                                      const drmModeModeInfo& timing) {
  const Size size{timing.hdisplay, timing.vdisplay};
  Expected<ScanoutBuffer> first = ScanoutBuffer::create(device, size);
  if (!first) return tl::unexpected(first.error());
  Expected<ScanoutBuffer> second = ScanoutBuffer::create(device, size);
  if (!second) return tl::unexpected(second.error());
  std::unique_ptr<LitOutput> output(
      new LitOutput(device, flips, path, timing, {std::move(*first), std::move(*second)}));
  if (Expected<void> set = output->set_mode(); !set) return tl::unexpected(set.error());
  return output;
}

Expected<void> LitOutput::set_mode() {
  const int fd = device_.fd();
  const ModeBlob mode(fd, &timing_, sizeof timing_);
  const KmsObject crtc = KmsObject::crtc(fd, path_.crtc);
  AtomicRequest request;
  request.set(KmsObject::connector(fd, path_.connector), "CRTC_ID", path_.crtc);
  request.set(crtc, "MODE_ID", mode.id());
  request.set(crtc, "ACTIVE", 1);
  clear_colour_tables(request, crtc);
  set_picture(request, KmsObject::plane(fd, path_.plane), path_, buffers_[front_]);
  if (const int error = request.commit(fd, DRM_MODE_ATOMIC_ALLOW_MODESET); error != 0)
    return refused("the mode", error);
  return {};
}

LitOutput::~LitOutput() {
  const int fd = device_.fd();
  const KmsObject crtc = KmsObject::crtc(fd, path_.crtc);
  const KmsObject plane = KmsObject::plane(fd, path_.plane);
  AtomicRequest request;
  request.set(KmsObject::connector(fd, path_.connector), "CRTC_ID", 0);
  request.set(crtc, "MODE_ID", 0);
  request.set(crtc, "ACTIVE", 0);
  request.set(plane, "FB_ID", 0);
  request.set(plane, "CRTC_ID", 0);
  // Where this fails the card is gone or another program's, and the output no longer ours to switch off.
  static_cast<void>(request.commit(fd, DRM_MODE_ATOMIC_ALLOW_MODESET));
}

bool LitOutput::is_lit() const {
  const KmsCrtc crtc(drmModeGetCrtc(device_.fd(), path_.crtc));
  return crtc && crtc->mode_valid != 0 && same_timing(crtc->mode, timing_);
}

Expected<std::int64_t> LitOutput::show(const GrayImage8& picture) {
  const std::size_t back = 1 - front_;
  if (picture.size() != buffers_[back].size())
    return device_error("a picture of " + text_of(picture.size()) + ", not of its mode's " +
                        text_of(buffers_[back].size()));
  buffers_[back].draw(picture);
  const std::int64_t until_us = monotonic_us() + flip_limit_us;
  flips_.expect(path_.crtc);
  if (Expected<void> flipping = commit_flip(buffers_[back].framebuffer(), until_us); !flipping)
    return tl::unexpected(flipping.error());
  Expected<std::int64_t> flipped = flips_.wait(path_.crtc, until_us);
  if (flipped) front_ = back;
  return flipped;
}

Expected<void> LitOutput::commit_flip(std::uint32_t framebuffer, std::int64_t until_us) {
  AtomicRequest request;
  request.set(KmsObject::plane(device_.fd(), path_.plane), "FB_ID", framebuffer);
  int error = 0;
  // Busy: a change that somebody else made has not come to its end.
  while ((error = request.commit(device_.fd(), DRM_MODE_ATOMIC_NONBLOCK | DRM_MODE_PAGE_FLIP_EVENT,
                                 flips_.event_tag())) == EBUSY &&
         monotonic_us() < until_us)
    poll(nullptr, 0, 1);
  if (error != 0) return refused("the picture", error);
  return {};
}

}  // namespace bodyscan
