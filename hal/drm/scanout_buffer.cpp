#include "hal/drm/scanout_buffer.hpp"

#include <array>
#include <cstring>
#include <utility>

#include <drm_fourcc.h>
#include <sys/mman.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

namespace bodyscan {
namespace {

constexpr std::uint32_t bits_a_pixel = 32;

}  // namespace

void draw_gray(const GrayImage8& picture, std::span<std::byte> pixels, std::size_t pitch_bytes) {
  for (int y = 0; y < picture.height(); ++y) {
    const std::uint8_t* gray = picture.row(y);
    std::byte* row = pixels.data() + static_cast<std::size_t>(y) * pitch_bytes;
    for (int x = 0; x < picture.width(); ++x) {
      const std::uint32_t pixel = gray[x] * 0x010101U;
      std::memcpy(row + static_cast<std::size_t>(x) * sizeof pixel, &pixel, sizeof pixel);
    }
  }
}

Expected<ScanoutBuffer> ScanoutBuffer::create(const DrmDevice& device, Size size) {
  ScanoutBuffer buffer(device.fd(), size);
  if (Expected<void> allocated = buffer.allocate(device); !allocated)
    return tl::unexpected(allocated.error());
  return buffer;
}

Expected<void> ScanoutBuffer::allocate(const DrmDevice& device) {
  const auto width = static_cast<std::uint32_t>(size_.width);
  const auto height = static_cast<std::uint32_t>(size_.height);
  std::uint32_t pitch = 0;
  std::uint64_t bytes = 0;
  if (drmModeCreateDumbBuffer(fd_, width, height, bits_a_pixel, 0, &handle_, &pitch, &bytes) != 0)
    return device.error("no memory for pictures");
  pitch_bytes_ = pitch;

  const std::array<std::uint32_t, 4> handles{handle_};
  const std::array<std::uint32_t, 4> pitches{pitch};
  const std::array<std::uint32_t, 4> offsets{};
  if (drmModeAddFB2(fd_, width, height, DRM_FORMAT_XRGB8888, handles.data(), pitches.data(), offsets.data(),
                    &framebuffer_, 0) != 0)
    return device.error("no framebuffer for pictures");

  std::uint64_t offset = 0;
  if (drmModeMapDumbBuffer(fd_, handle_, &offset) != 0) return device.error("picture memory has no address");
  void* memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd_, static_cast<off_t>(offset));
  if (memory == MAP_FAILED) return device.error("picture memory cannot be mapped");
  pixels_ = {static_cast<std::byte*>(memory), bytes};
  std::memset(memory, 0, bytes);
  return {};
}

ScanoutBuffer::ScanoutBuffer(ScanoutBuffer&& other) noexcept
    : fd_(other.fd_),
      size_(other.size_),
      handle_(std::exchange(other.handle_, 0)),
      framebuffer_(std::exchange(other.framebuffer_, 0)),
      pitch_bytes_(other.pitch_bytes_),
      pixels_(std::exchange(other.pixels_, {})) {}

ScanoutBuffer& ScanoutBuffer::operator=(ScanoutBuffer&& other) noexcept {
  std::swap(fd_, other.fd_);
  std::swap(size_, other.size_);
  std::swap(handle_, other.handle_);
  std::swap(framebuffer_, other.framebuffer_);
  std::swap(pitch_bytes_, other.pitch_bytes_);
  std::swap(pixels_, other.pixels_);
  return *this;
}

ScanoutBuffer::~ScanoutBuffer() {
  if (!pixels_.empty()) munmap(pixels_.data(), pixels_.size());
  if (framebuffer_ != 0) drmModeRmFB(fd_, framebuffer_);
  if (handle_ != 0) drmModeDestroyDumbBuffer(fd_, handle_);
}

ModeBlob::ModeBlob(int fd, const void* timing, std::size_t bytes) : fd_(fd) {
  if (drmModeCreatePropertyBlob(fd, timing, bytes, &id_) != 0) id_ = 0;
}

ModeBlob::~ModeBlob() {
  if (id_ != 0) drmModeDestroyPropertyBlob(fd_, id_);
}

}  // namespace bodyscan
