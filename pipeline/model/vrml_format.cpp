#include "pipeline/model/vrml_format.hpp"

#include <array>
#include <cmath>
#include <cstring>

namespace bodyscan::vrml {
namespace {

constexpr std::array<char, 200> digit_pairs = [] {
  std::array<char, 200> pairs{};
  for (std::size_t i = 0; i < 100; ++i) {
    pairs[2 * i] = static_cast<char>('0' + i / 10);
    pairs[2 * i + 1] = static_cast<char>('0' + i % 10);
  }
  return pairs;
}();

char* write_pair(std::uint32_t value, char* out) {
  std::memcpy(out, &digit_pairs[2 * value], 2);
  return out + 2;
}

char* write_quad(std::uint32_t value, char* out) {
  write_pair(value / 100, out);
  return write_pair(value % 100, out + 2);
}

char* write_below_10000(std::uint32_t value, char* out) {
  if (value >= 1000) return write_quad(value, out);
  if (value >= 100) {
    *out = static_cast<char>('0' + value / 100);
    return write_pair(value % 100, out + 1);
  }
  if (value >= 10) return write_pair(value, out);
  *out = static_cast<char>('0' + value);
  return out + 1;
}

char* write_integer(std::uint32_t value, char* out) {
  if (value < 10000) return write_below_10000(value, out);
  const std::uint32_t high = value / 10000;
  out = high < 10000 ? write_below_10000(high, out)
                     : write_quad(high % 10000, write_below_10000(high / 10000, out));
  return write_quad(value % 10000, out);
}

// |value| <= max_coordinate_mm. The product is exact in double, so this rounds correctly (halves away from
// 0).
char* write_coordinate(float value, char* out) {
  const auto steps =
      static_cast<std::uint32_t>(std::floor(std::abs(static_cast<double>(value)) * 10000.0 + 0.5));
  *out = '-';
  out += value < 0 && steps != 0 ? 1 : 0;
  out = write_integer(steps / 10000, out);
  const std::uint32_t fraction = steps % 10000;
  if (fraction == 0) return out;
  *out = '.';
  out = write_quad(fraction, out + 1);
  while (out[-1] == '0') --out;
  return out;
}

// A component with the separator after it.
struct ColorText {
  std::array<char, 8> bytes{};
  std::size_t size = 0;
};

constexpr std::array<ColorText, 256> color_texts = [] {
  std::array<ColorText, 256> texts{};
  for (unsigned i = 0; i < 256; ++i) {
    ColorText& text = texts[i];
    const unsigned thousandths = (i * 1000 + 127) / 255;
    text.bytes[text.size++] = static_cast<char>('0' + thousandths / 1000);
    if (thousandths % 1000 != 0) {
      text.bytes[text.size++] = '.';
      for (unsigned rest = thousandths % 1000, unit = 100; rest != 0; rest %= unit, unit /= 10) {
        text.bytes[text.size++] = static_cast<char>('0' + rest / unit);
      }
    }
    text.bytes[text.size++] = ' ';
  }
  return texts;
}();

bool writable(const Point3f& point) {
  return std::abs(point.x) <= max_coordinate_mm && std::abs(point.y) <= max_coordinate_mm &&
         std::abs(point.z) <= max_coordinate_mm;  // false for NaN
}

bool writable(const Face& face, std::uint32_t point_count) {
  return face[0] < point_count && face[1] < point_count && face[2] < point_count && face[0] != face[1] &&
         face[1] != face[2] && face[2] != face[0];
}

// Length of the UTF-8 sequence that `text` begins with (Unicode 15, table 3-7); 0 if there is none.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned>(static_cast<unsigned char>(text[i])) : 0U;
  };
  const auto continues = [&](std::size_t i) { return (byte(i) & 0xC0U) == 0x80U; };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first <= 0xDF) return continues(1) ? 2 : 0;
  if (first >= 0xE0 && first <= 0xEF) {
    const bool overlong = first == 0xE0 && byte(1) < 0xA0;
    const bool surrogate = first == 0xED && byte(1) >= 0xA0;
    return continues(1) && continues(2) && !overlong && !surrogate ? 3 : 0;
  }
  if (first >= 0xF0 && first <= 0xF4) {
    const bool overlong = first == 0xF0 && byte(1) < 0x90;
    const bool beyond = first == 0xF4 && byte(1) >= 0x90;
    return continues(1) && continues(2) && continues(3) && !overlong && !beyond ? 4 : 0;
  }
  return 0;
}

}  // namespace

Formatted format_points(std::span<const Point3f> points, char* out) {
  char* end = out;
  std::size_t items = 0;
  for (const Point3f& point : points) {
    if (!writable(point)) break;
    end = write_coordinate(point.x, end);
    *end++ = ' ';
    end = write_coordinate(point.y, end);
    *end++ = ' ';
    end = write_coordinate(point.z, end);
    *end++ = '\n';
    ++items;
  }
  return {items, static_cast<std::size_t>(end - out)};
}

Formatted format_colors(std::span<const Rgb8> colors, char* out) {
  char* end = out;
  for (const Rgb8& color : colors) {
    for (const std::uint8_t component : color) {
      const ColorText& text = color_texts[component];
      std::memcpy(end, text.bytes.data(), 6);
      end += text.size;
    }
    end[-1] = '\n';
  }
  return {colors.size(), static_cast<std::size_t>(end - out)};
}

Formatted format_faces(std::span<const Face> faces, std::uint32_t point_count, char* out) {
  char* end = out;
  std::size_t items = 0;
  for (const Face& face : faces) {
    if (!writable(face, point_count)) break;
    for (const std::uint32_t index : face) {
      end = write_integer(index, end);
      *end++ = ' ';
    }
    end += std::string_view("-1\n").copy(end, 3);
    ++items;
  }
  return {items, static_cast<std::size_t>(end - out)};
}

std::string quoted(std::string_view text) {
  std::string result = "\"";
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0) {
      result += '?';
    } else if (length == 1 && (static_cast<unsigned char>(text[0]) < 0x20 || text[0] == 0x7F)) {
      result += ' ';
    } else {
      result += text[0] == '"' ? std::string_view("'") : text[0] == '\\' ? "/" : text.substr(0, length);
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return result + '"';
}

}  // namespace bodyscan::vrml
