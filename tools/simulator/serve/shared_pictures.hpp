#pragma once

#include "hal/unique_fd.hpp"
#include "pipeline/base/error.hpp"
#include "pipeline/base/image.hpp"

#include <cstdint>
#include <span>

namespace bodyscan::simulator {

// A memory file with a virtual projector's two pictures (hal/virtual_projector/wire.hpp), black at first. Its
// size is sealed: a client cannot take the memory away from under us.
class SharedPictures {
 public:
  static Expected<SharedPictures> make(Size size);
  SharedPictures(SharedPictures&& other) noexcept;
  SharedPictures& operator=(SharedPictures&& other) noexcept;
  ~SharedPictures();

  [[nodiscard]] int fd() const { return fd_.get(); }
  [[nodiscard]] Size size() const { return size_; }
  // A copy of picture 0 or 1 as it is now.
  [[nodiscard]] GrayImage8 picture(std::uint32_t index) const;

 private:
  SharedPictures() = default;

  UniqueFd fd_;
  Size size_;
  std::span<std::uint8_t> memory_;
};

}  // namespace bodyscan::simulator
