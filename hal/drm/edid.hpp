#pragma once

#include "pipeline/base/error.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace bodyscan {

// Who a display says it is (VESA E-EDID 1.4, sections 3.4 and 3.10.3). Texts are printable ASCII; a byte that
// is none became '?'.
struct Edid {
  std::string maker;  // three letters: "NEC"
  std::uint16_t product = 0;
  std::uint32_t serial = 0;  // 0 where the display has none, or has it as text
  std::string serial_text;
  std::string name;  // "NEC LT220"
};

// Of the base block; extensions behind it are not looked at. A block that is too short, has another header or
// a wrong checksum is an error of kind `device`.
Expected<Edid> parse_edid(std::span<const std::byte> bytes);

// As in ProjectorOutput: "NEC 4a21 1234567", without the last part where there is no serial number.
std::string identity(const Edid& edid);

}  // namespace bodyscan
