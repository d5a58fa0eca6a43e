#pragma once

#include "pipeline/base/pixel_memory.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>

namespace bodyscan {

struct Size {
  int width = 0;
  int height = 0;

  friend bool operator==(Size, Size) = default;
  [[nodiscard]] std::size_t area() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
};

// A row-major raster without padding; pixel centres lie at integer coordinates. Move-only: frames are large.
template <class Pixel>
class Image {
 public:
  Image() = default;
  // Pixels are left uninitialised.
  explicit Image(Size size)
      : size_(size), pixels_(static_cast<Pixel*>(allocate_pixels(size.area() * sizeof(Pixel)))) {
    static_assert(std::is_trivially_destructible_v<Pixel>);
    std::uninitialized_default_construct_n(pixels_.get(), size.area());
  }
  Image(Size size, Pixel fill) : Image(size) { std::fill_n(pixels_.get(), size.area(), fill); }
  Image(Image&& other) noexcept : size_(std::exchange(other.size_, {})), pixels_(std::move(other.pixels_)) {}
  Image& operator=(Image&& other) noexcept {
    size_ = std::exchange(other.size_, {});
    pixels_ = std::move(other.pixels_);
    return *this;
  }
  ~Image() = default;

  [[nodiscard]] Image clone() const {
    Image copy(size_);
    std::copy_n(pixels_.get(), size_.area(), copy.pixels_.get());
    return copy;
  }

  [[nodiscard]] Size size() const { return size_; }
  [[nodiscard]] int width() const { return size_.width; }
  [[nodiscard]] int height() const { return size_.height; }
  [[nodiscard]] bool empty() const { return size_.area() == 0; }

  [[nodiscard]] Pixel* row(int y) { return pixels_.get() + offset(y); }
  [[nodiscard]] const Pixel* row(int y) const { return pixels_.get() + offset(y); }
  [[nodiscard]] Pixel& operator()(int x, int y) { return row(y)[x]; }
  [[nodiscard]] const Pixel& operator()(int x, int y) const { return row(y)[x]; }
  [[nodiscard]] Pixel* data() { return pixels_.get(); }
  [[nodiscard]] const Pixel* data() const { return pixels_.get(); }
  [[nodiscard]] std::span<Pixel> pixels() { return {pixels_.get(), size_.area()}; }
  [[nodiscard]] std::span<const Pixel> pixels() const { return {pixels_.get(), size_.area()}; }

 private:
  [[nodiscard]] std::size_t offset(int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.width);
  }

  Size size_;
  std::unique_ptr<Pixel[], FreePixels> pixels_;
};

using Rgb8 = std::array<std::uint8_t, 3>;
using GrayImage8 = Image<std::uint8_t>;
using GrayImage16 = Image<std::uint16_t>;
using ColorImage8 = Image<Rgb8>;
using FloatImage = Image<float>;

}  // namespace bodyscan
