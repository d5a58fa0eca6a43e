#include "tools/simulator/serve/ptp/dataset.hpp"

namespace bodyscan::simulator::ptp {

DatasetWriter& DatasetWriter::text(std::string_view text) {
  constexpr std::size_t longest = 254;  // the count is a byte and includes the final zero
  if (text.empty()) return put(std::uint8_t{0});
  text = text.substr(0, longest);
  put(static_cast<std::uint8_t>(text.size() + 1));
  for (const char character : text) put(static_cast<std::uint16_t>(static_cast<unsigned char>(character)));
  return put(std::uint16_t{0});
}

DatasetWriter& DatasetWriter::raw(std::span<const std::uint8_t> bytes) {
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  return *this;
}

std::optional<std::string> DatasetReader::text() {
  const std::optional<std::uint8_t> count = get<std::uint8_t>();
  if (!count || rest_.size() < 2 * std::size_t{*count}) return fail();
  std::string text;
  for (int i = 0; i < *count; ++i) {
    const std::uint16_t unit = *get<std::uint16_t>();
    text += unit < 0x80 ? static_cast<char>(unit) : '?';
  }
  while (!text.empty() && text.back() == '\0') text.pop_back();
  return text;
}

}  // namespace bodyscan::simulator::ptp
