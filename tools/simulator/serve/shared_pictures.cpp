#include "tools/simulator/serve/shared_pictures.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/mman.h>

namespace bodyscan::simulator {

Expected<SharedPictures> SharedPictures::make(Size size) {
  const std::size_t bytes = 2 * size.area();
  SharedPictures pictures;
  pictures.size_ = size;
  pictures.fd_ = UniqueFd(memfd_create("projector pictures", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  const int fd = pictures.fd();
  if (fd < 0 || ftruncate(fd, static_cast<off_t>(bytes)) != 0 ||
      fcntl(fd, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0)
    return device_error(std::string("the projector's memory: ") + std::strerror(errno));
  void* const memory = mmap(nullptr, bytes, PROT_READ, MAP_SHARED, fd, 0);
  if (memory == MAP_FAILED)
    return device_error(std::string("the projector's memory: ") + std::strerror(errno));
  pictures.memory_ = {static_cast<std::uint8_t*>(memory), bytes};
  return pictures;
}

SharedPictures::SharedPictures(SharedPictures&& other) noexcept
    : fd_(std::move(other.fd_)), size_(other.size_), memory_(std::exchange(other.memory_, {})) {}

SharedPictures& SharedPictures::operator=(SharedPictures&& other) noexcept {
  std::swap(fd_, other.fd_);
  std::swap(size_, other.size_);
  std::swap(memory_, other.memory_);
  return *this;
}

SharedPictures::~SharedPictures() {
  if (!memory_.empty()) munmap(memory_.data(), memory_.size());
}

GrayImage8 SharedPictures::picture(std::uint32_t index) const {
  GrayImage8 copy(size_);
  std::ranges::copy(memory_.subspan(index * size_.area(), size_.area()), copy.data());
  return copy;
}

}  // namespace bodyscan::simulator
