#pragma once

#include "tools/simulator/serve/ptp/codes.hpp"
#include "tools/simulator/serve/ptp/dataset.hpp"

#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace bodyscan::simulator::ptp {

// The data types that a D5000's properties have.
using Value =
    std::variant<std::int8_t, std::uint8_t, std::int16_t, std::uint16_t, std::uint32_t, std::string>;

// A device property: its value and what it may be set to.
struct Property {
  PropertyCode code{};
  Value value;
  bool writable = true;
  std::vector<Value> choices = {};  // an enumeration where there are any ...
  struct Range {
    Value least, most, step;
  };
  std::optional<Range> range = std::nullopt;  // ... or a range
};

// The DevicePropDesc dataset (ISO 15740, 13.4.4); `factory` is the value after a reset.
Bytes describe(const Property& property, const Value& factory);
Bytes encode(const Value& value);
// A value of the same type as `like`; nothing where the data are not one.
std::optional<Value> decode(std::span<const std::uint8_t> data, const Value& like);
// Whether the property may be set to a value of its type.
bool allows(const Property& property, const Value& value);

}  // namespace bodyscan::simulator::ptp
