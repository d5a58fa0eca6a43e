#include "tools/simulator/serve/ptp/property.hpp"

#include <algorithm>
#include <array>
#include <type_traits>

namespace bodyscan::simulator::ptp {
namespace {

std::uint16_t data_type(const Value& value) {  // ISO 15740, 5.3
  constexpr std::array<std::uint16_t, std::variant_size_v<Value>> types{0x0001, 0x0002, 0x0003,
                                                                        0x0004, 0x0006, 0xFFFF};
  return types.at(value.index());
}

void put(DatasetWriter& writer, const Value& value) {
  std::visit(
      [&](const auto& held) {
        if constexpr (std::is_same_v<std::decay_t<decltype(held)>, std::string>)
          writer.text(held);
        else
          writer.put(held);
      },
      value);
}

}  // namespace

Bytes describe(const Property& property, const Value& factory) {
  enum class Form : std::uint8_t { none = 0, range = 1, enumeration = 2 };
  DatasetWriter writer;
  writer.put(property.code).put(data_type(property.value));
  writer.put(static_cast<std::uint8_t>(property.writable ? 1 : 0));
  put(writer, factory);
  put(writer, property.value);
  if (!property.choices.empty()) {
    writer.put(Form::enumeration).put(static_cast<std::uint16_t>(property.choices.size()));
    for (const Value& choice : property.choices) put(writer, choice);
  } else if (property.range) {
    writer.put(Form::range);
    for (const Value* limit : {&property.range->least, &property.range->most, &property.range->step})
      put(writer, *limit);
  } else {
    writer.put(Form::none);
  }
  return writer.take();
}

Bytes encode(const Value& value) {
  DatasetWriter writer;
  put(writer, value);
  return writer.take();
}

std::optional<Value> decode(std::span<const std::uint8_t> data, const Value& like) {
  DatasetReader reader(data);
  return std::visit(
      [&](const auto& held) -> std::optional<Value> {
        using Held = std::decay_t<decltype(held)>;
        if constexpr (std::is_same_v<Held, std::string>)
          return reader.text();
        else
          return reader.get<Held>();
      },
      like);
}

bool allows(const Property& property, const Value& value) {
  if (!property.choices.empty()) return std::ranges::find(property.choices, value) != property.choices.end();
  return !property.range || (property.range->least <= value && value <= property.range->most);
}

}  // namespace bodyscan::simulator::ptp
