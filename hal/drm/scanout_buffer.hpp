#pragma once

#include "hal/drm/drm_device.hpp"
#include "pipeline/base/image.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace bodyscan {

// Writes grey levels as XRGB8888; `pitch_bytes` lie between the starts of rows.
void draw_gray(const GrayImage8& picture, std::span<std::byte> pixels, std::size_t pitch_bytes);

// Memory of the card that a plane can show (a dumb buffer), mapped, and the framebuffer that names it.
class ScanoutBuffer {
 public:
  // Black.
  static Expected<ScanoutBuffer> create(const DrmDevice& device, Size size);

  ScanoutBuffer(ScanoutBuffer&& other) noexcept;
  ScanoutBuffer& operator=(ScanoutBuffer&& other) noexcept;
  ~ScanoutBuffer();

  [[nodiscard]] std::uint32_t framebuffer() const { return framebuffer_; }
  [[nodiscard]] Size size() const { return size_; }
  // Of the buffer's size.
  void draw(const GrayImage8& picture) { draw_gray(picture, pixels_, pitch_bytes_); }

 private:
  ScanoutBuffer(int fd, Size size) : fd_(fd), size_(size) {}
  Expected<void> allocate(const DrmDevice& device);

  int fd_;
  Size size_;
  std::uint32_t handle_ = 0;
  std::uint32_t framebuffer_ = 0;
  std::size_t pitch_bytes_ = 0;
  std::span<std::byte> pixels_;
};

// A mode as the kernel takes it (a property blob).
class ModeBlob {
 public:
  ModeBlob(int fd, const void* timing, std::size_t bytes);
  ModeBlob(const ModeBlob&) = delete;
  ModeBlob& operator=(const ModeBlob&) = delete;
  ~ModeBlob();

  // 0 where the kernel refused.
  [[nodiscard]] std::uint32_t id() const { return id_; }

 private:
  int fd_;
  std::uint32_t id_ = 0;
};

}  // namespace bodyscan
