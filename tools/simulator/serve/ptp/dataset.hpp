#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace bodyscan::simulator::ptp {

using Bytes = std::vector<std::uint8_t>;

template <class Value>
concept Code = std::integral<Value> || std::is_enum_v<Value>;

// Puts a PTP dataset together: little-endian numbers, strings, arrays (ISO 15740, clause 5.3).
class DatasetWriter {
 public:
  template <Code Value>
  DatasetWriter& put(Value value) {
    auto rest = static_cast<std::uint64_t>(value);
    for (std::size_t i = 0; i < sizeof(Value); ++i, rest >>= 8)
      bytes_.push_back(static_cast<std::uint8_t>(rest));
    return *this;
  }
  // ASCII; cut off after 254 characters.
  DatasetWriter& text(std::string_view text);
  template <Code Value>
  DatasetWriter& array(const std::vector<Value>& values) {
    put(static_cast<std::uint32_t>(values.size()));
    for (const Value value : values) put(value);
    return *this;
  }
  DatasetWriter& raw(std::span<const std::uint8_t> bytes);

  [[nodiscard]] const Bytes& bytes() const { return bytes_; }
  [[nodiscard]] Bytes take() { return std::move(bytes_); }

 private:
  Bytes bytes_;
};

// Reads what an initiator sent. Every getter answers nothing, and goes on to, once the dataset has ended too
// early.
class DatasetReader {
 public:
  explicit DatasetReader(std::span<const std::uint8_t> bytes) : rest_(bytes) {}

  template <Code Value>
  std::optional<Value> get() {
    if (rest_.size() < sizeof(Value)) return fail();
    std::uint64_t value = 0;
    for (std::size_t i = sizeof(Value); i-- > 0;) value = value << 8 | rest_[i];
    rest_ = rest_.subspan(sizeof(Value));
    return static_cast<Value>(value);
  }
  // Characters beyond ASCII come out as '?'.
  std::optional<std::string> text();
  [[nodiscard]] std::span<const std::uint8_t> rest() const { return rest_; }

 private:
  std::nullopt_t fail() {
    rest_ = {};
    return std::nullopt;
  }

  std::span<const std::uint8_t> rest_;
};

}  // namespace bodyscan::simulator::ptp
