#include "hal/drm/edid.hpp"

#include <array>
#include <cstdio>
#include <numeric>

namespace bodyscan {
namespace {

constexpr std::size_t block_bytes = 128;
constexpr std::size_t descriptor_bytes = 18;
constexpr std::array<std::size_t, 4> descriptors{54, 72, 90, 108};
constexpr unsigned serial_tag = 0xff;
constexpr unsigned name_tag = 0xfc;

using Block = std::span<const std::byte, block_bytes>;

unsigned at(Block block, std::size_t index) {
  return std::to_integer<unsigned>(block[index]);
}

char printable(unsigned character) {
  return character >= 0x20 && character < 0x7f ? static_cast<char>(character) : '?';
}

bool has_header(Block block) {
  for (std::size_t i = 0; i < 8; ++i)
    if (at(block, i) != (i == 0 || i == 7 ? 0x00U : 0xffU)) return false;
  return true;
}

unsigned sum(Block block) {
  return std::accumulate(block.begin(), block.end(), 0U, [](unsigned total, std::byte value) {
    return (total + std::to_integer<unsigned>(value)) & 0xffU;
  });
}

// Five bits a letter, 1 is A.
std::string maker(Block block) {
  const unsigned packed = at(block, 8) << 8 | at(block, 9);
  std::string letters;
  for (const unsigned shift : {10U, 5U, 0U}) {
    const unsigned letter = packed >> shift & 0x1fU;
    letters += letter >= 1 && letter <= 26 ? static_cast<char>('A' + letter - 1) : '?';
  }
  return letters;
}

// Ends at a line feed; padded with spaces.
std::string descriptor_text(Block block, std::size_t start) {
  std::string text;
  for (std::size_t i = start + 5; i < start + descriptor_bytes && at(block, i) != '\n'; ++i)
    text += printable(at(block, i));
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

}  // namespace

Expected<Edid> parse_edid(std::span<const std::byte> bytes) {
  if (bytes.size() < block_bytes)
    return device_error("EDID: " + std::to_string(bytes.size()) + " bytes, not 128 or more");
  const Block block = bytes.first<block_bytes>();
  if (!has_header(block)) return device_error("EDID: does not begin with an EDID's header");
  if (sum(block) != 0) return device_error("EDID: wrong checksum");

  Edid edid;
  edid.maker = maker(block);
  edid.product = static_cast<std::uint16_t>(at(block, 10) | at(block, 11) << 8);
  edid.serial = at(block, 12) | at(block, 13) << 8 | at(block, 14) << 16 | at(block, 15) << 24;
  for (const std::size_t start : descriptors) {
    const bool timing = at(block, start) != 0 || at(block, start + 1) != 0;
    if (timing) continue;
    const unsigned tag = at(block, start + 3);
    if (tag == serial_tag) edid.serial_text = descriptor_text(block, start);
    if (tag == name_tag) edid.name = descriptor_text(block, start);
  }
  return edid;
}

std::string identity(const Edid& edid) {
  std::array<char, 8> product{};
  std::snprintf(product.data(), product.size(), "%04x", unsigned{edid.product});
  std::string text = edid.maker;
  text.append(" ").append(product.data());
  if (!edid.serial_text.empty()) return text.append(" ").append(edid.serial_text);
  if (edid.serial != 0) return text.append(" ").append(std::to_string(edid.serial));
  return text;
}

}  // namespace bodyscan
