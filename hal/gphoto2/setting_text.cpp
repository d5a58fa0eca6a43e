#include "hal/gphoto2/setting_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>

namespace bodyscan::gphoto2 {
namespace {

// All of `text` as a positive number.
std::optional<double> positive_number(std::string_view text) {
  double number = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number, std::chars_format::fixed);
  if (error != std::errc() || stop != end || !std::isfinite(number) || number <= 0) return {};
  return number;
}

std::string_view without_suffix(std::string_view text, char suffix) {
  if (text.ends_with(suffix)) text.remove_suffix(1);
  if (text.ends_with(' ')) text.remove_suffix(1);
  return text;
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return lower;
}

bool contains(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

// Higher is better; negative for what is no plain JPEG.
int jpeg_rank(std::string_view choice) {
  const std::string text = lower_case(choice);
  for (const char* other : {"raw", "nef", "tiff", "heif", "cr2", "cr3"})
    if (contains(text, other)) return -1;
  constexpr std::array<std::string_view, 7> qualities{"low",    "basic", "standard",  "norm",
                                                      "medium", "fine",  "extra fine"};
  int rank = contains(text, "jpeg") || contains(text, "jpg") ? 0 : -1;
  for (std::size_t i = 0; i < qualities.size(); ++i)
    if (contains(text, qualities[i])) rank = static_cast<int>(i) + 1;
  if (contains(text, "super fine")) rank = qualities.size();
  if (rank < 0) return rank;
  rank = rank * 4 + 2;
  if (contains(text, "large")) rank += 2;
  if (contains(text, "small")) rank -= 2;
  if (text.ends_with('*')) rank += 1;  // Nikon's "optimal quality"
  return rank;
}

}  // namespace

std::optional<double> exposure_seconds(std::string_view text) {
  text = without_suffix(text, 's');
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) return positive_number(text);
  const auto numerator = positive_number(text.substr(0, slash));
  const auto denominator = positive_number(text.substr(slash + 1));
  if (!numerator || !denominator) return {};
  return *numerator / *denominator;
}

std::optional<double> f_number(std::string_view text) {
  for (const std::string_view prefix : {"f/", "F/", "f", "F"}) {
    if (!text.starts_with(prefix)) continue;
    text.remove_prefix(prefix.size());
    break;
  }
  return positive_number(text);
}

std::optional<double> iso(std::string_view text) {
  return positive_number(text);
}

std::optional<double> percent(std::string_view text) {
  if (!text.ends_with('%')) return {};
  if (text == "0%") return 0;
  return positive_number(without_suffix(text, '%'));
}

std::optional<Size> picture_size(std::string_view text) {
  const std::size_t cross = text.find('x');
  if (cross == std::string_view::npos) return {};
  const auto side = [](std::string_view digits) -> int {
    int pixels = 0;
    const char* end = digits.data() + digits.size();
    const auto [stop, error] = std::from_chars(digits.data(), end, pixels);
    return error == std::errc() && stop == end && pixels <= 100'000 ? pixels : 0;
  };
  const Size size{side(text.substr(0, cross)), side(text.substr(cross + 1))};
  if (size.width <= 0 || size.height <= 0) return {};
  return size;
}

std::optional<std::string> nearest_choice(
    const std::vector<std::string>& choices, double wanted,
    const std::function<std::optional<double>(std::string_view)>& meaning) {
  std::optional<std::string> nearest;
  double smallest = std::numeric_limits<double>::infinity();
  for (const std::string& choice : choices) {
    const auto value = meaning(choice);
    if (!value || *value <= 0) continue;
    const double distance = std::abs(std::log(*value / wanted));
    if (distance >= smallest) continue;
    smallest = distance;
    nearest = choice;
  }
  return nearest;
}

std::optional<std::string> best_jpeg(const std::vector<std::string>& choices) {
  std::optional<std::string> best;
  int highest = -1;
  for (const std::string& choice : choices) {
    const int rank = jpeg_rank(choice);
    if (rank <= highest) continue;
    highest = rank;
    best = choice;
  }
  return best;
}

}  // namespace bodyscan::gphoto2
