#pragma once

#include <array>
#include <charconv>
#include <string>

namespace bodyscan {

// A finite number with that many decimals; never depends on the locale.
inline std::string fixed_text(double value, int decimals) {
  std::array<char, 400> digits{};  // DBL_MAX has 309 before the point
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed, decimals);
  return {digits.data(), end.ptr};
}

// A finite number with that many significant digits, as printf's %g: "0.0012", "1.5e-07".
inline std::string significant_text(double value, int digits) {
  std::array<char, 400> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, digits);
  return {text.data(), end.ptr};
}

// A finite number as fixed_text without trailing zeros: "25", "12.5", "0".
inline std::string short_text(double value, int max_decimals) {
  std::string text = fixed_text(value, max_decimals);
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  if (text == "-0") text.erase(0, 1);
  return text;
}

}  // namespace bodyscan
