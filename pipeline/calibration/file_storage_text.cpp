#include "pipeline/calibration/file_storage_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

namespace bodyscan {
namespace {

constexpr std::string_view blanks = " \t\r\n";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) + 1 - first);
}

// The line up to a '#' that starts it or follows a blank, outside double quotes.
std::string_view without_comment(std::string_view line) {
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') quoted = !quoted;
    if (line[i] == '#' && !quoted && (i == 0 || blanks.find(line[i - 1]) != std::string_view::npos))
      return line.substr(0, i);
  }
  return line;
}

bool is_key(std::string_view text) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !text.empty() && std::all_of(text.begin(), text.end(), allowed);
}

// Bytes of a message that may come from a damaged file.
std::string quoted(std::string_view text) {
  constexpr std::size_t longest = 24;
  std::string result = "'";
  for (const char c : text.substr(0, longest)) result += c >= ' ' && c <= '~' ? c : '?';
  return result + (text.size() > longest ? "...'" : "'");
}

// Reads a value from the front, word by word.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : rest_(trimmed(text)) {}

  [[nodiscard]] bool done() const { return rest_.empty(); }

  bool accept(char symbol) {
    if (rest_.empty() || rest_.front() != symbol) return false;
    rest_ = trimmed(rest_.substr(1));
    return true;
  }

  // Up to the next blank, comma, bracket or (for "rows:") behind the next colon.
  std::string_view word() {
    std::size_t end = std::min(rest_.find_first_of(" \t\r\n,[]:"), rest_.size());
    if (end < rest_.size() && rest_[end] == ':') ++end;
    const std::string_view word = rest_.substr(0, end);
    rest_ = trimmed(rest_.substr(end));
    return word;
  }

 private:
  std::string_view rest_;
};

// YAML writes ".Nan" and "-.Inf".
bool names_no_finite_number(std::string_view word) {
  if (word.starts_with('+') || word.starts_with('-')) word.remove_prefix(1);
  return word == ".nan" || word == ".NaN" || word == ".Nan" || word == ".inf" || word == ".Inf";
}

Expected<double> number(std::string_view word) {
  if (names_no_finite_number(word)) return input_error("not finite");
  const bool plus = word.starts_with('+') && !word.starts_with("+-");
  const std::string_view digits = plus ? word.substr(1) : word;
  const char* const last = digits.data() + digits.size();
  double value = 0;
  const auto [end, code] = std::from_chars(digits.data(), last, value);
  if (code == std::errc::result_out_of_range) return input_error(quoted(word) + " is out of range");
  if (code != std::errc() || end != last) return input_error(quoted(word) + " is not a number");
  if (!std::isfinite(value)) return input_error("not finite");
  return value;
}

// "[ 1, 2, 3 ]" with at most `most` numbers.
Expected<std::vector<double>> numbers(Scanner& scanner, std::size_t most) {
  if (!scanner.accept('[')) return input_error("not a sequence of numbers");
  std::vector<double> values;
  if (scanner.accept(']')) return values;
  for (;;) {
    const Expected<double> value = number(scanner.word());
    if (!value) return tl::unexpected(value.error());
    values.push_back(*value);
    if (scanner.accept(']')) return values;
    if (!scanner.accept(',')) return input_error("a comma or ] is missing");
    if (values.size() == most) return input_error("more than " + std::to_string(most) + " numbers");
  }
}

struct Matrix {
  std::optional<double> rows;
  std::optional<double> columns;
  bool typed = false;
  std::optional<std::vector<double>> data;
};

Expected<void> read_field(Scanner& scanner, std::size_t most, Matrix& matrix) {
  const std::string_view field = scanner.word();
  if ((field == "rows:" && !matrix.rows) || (field == "cols:" && !matrix.columns))
    return number(scanner.word()).map([&](double n) {
      (field == "rows:" ? matrix.rows : matrix.columns) = n;
    });
  if (field == "dt:" && !matrix.typed) {
    const std::string_view type = scanner.word();
    matrix.typed = type == "d" || type == "f" || type == "\"d\"" || type == "\"f\"";
    if (!matrix.typed) return input_error("dt: " + quoted(type) + " is neither d nor f");
    return {};
  }
  if (field == "data:" && !matrix.data)
    return numbers(scanner, most).map([&](std::vector<double> values) { matrix.data = std::move(values); });
  return input_error(quoted(field) + " is not expected here");
}

template <class Number>
std::string flow_sequence(std::span<const Number> values, std::string_view separator) {
  std::string text = "[ ";
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::array<char, 32> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), values[i]).ptr;
    if (i > 0) text += separator;
    text.append(digits.data(), end);
  }
  return text + " ]\n";
}

}  // namespace

Expected<FileStorageText> FileStorageText::parse(std::string_view text) {
  FileStorageText storage;
  std::string* open = nullptr;  // the value that indented lines belong to
  bool ended = false;
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t length = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, length);
    text.remove_prefix(std::min(length + 1, text.size()));
    const std::string place = "line " + std::to_string(number) + ": ";
    const std::string_view content = trimmed(without_comment(line));
    if (number == 1) {
      if (content != "%YAML:1.0" && content != "%YAML 1.0")
        return input_error("not an OpenCV FileStorage YAML file");
      continue;
    }
    if (content.empty() || (content == "---" && open == nullptr)) continue;
    if (ended) return input_error(place + "text after the end of the document");
    if (content == "...") {
      ended = true;
    } else if (line.front() == ' ' || line.front() == '\t') {
      if (open == nullptr) return input_error(place + "a value without a key");
      open->append(content).push_back('\n');
    } else {
      const std::size_t colon = content.find(':');
      const std::string_view key = trimmed(content.substr(0, colon));
      if (colon == std::string_view::npos || !is_key(key)) return input_error(place + "not \"key: value\"");
      const auto [entry, added] = storage.values_.emplace(key, content.substr(colon + 1));
      if (!added) return input_error(place + std::string(key) + " occurs twice");
      open = &entry->second;
      open->push_back('\n');
    }
  }
  return storage;
}

Expected<std::string_view> FileStorageText::value(const std::string& key) const {
  const auto found = values_.find(key);
  if (found == values_.end()) return input_error(key + ": missing");
  return found->second;
}

Expected<std::vector<double>> FileStorageText::sequence(const std::string& key, std::size_t count) const {
  const Expected<std::string_view> text = value(key);
  if (!text) return tl::unexpected(text.error());
  Scanner scanner(*text);
  Expected<std::vector<double>> values = numbers(scanner, count);
  if (!values) return tl::unexpected(values.error().within(key));
  if (values->size() != count || !scanner.done())
    return input_error(key + ": not a sequence of " + std::to_string(count) + " numbers");
  return values;
}

std::optional<double> FileStorageText::optional_number(const std::string& key) const {
  const Expected<std::string_view> text = value(key);
  if (!text) return std::nullopt;
  Scanner scanner(*text);
  const Expected<double> value = number(scanner.word());
  return value && scanner.done() ? std::optional(*value) : std::nullopt;
}

Expected<std::vector<double>> FileStorageText::matrix(const std::string& key, int rows, int columns) const {
  const Expected<std::string_view> text = value(key);
  if (!text) return tl::unexpected(text.error());
  const std::string shape = std::to_string(rows) + "x" + std::to_string(columns);
  const auto count = static_cast<std::size_t>(rows * columns);
  Scanner scanner(*text);
  if (scanner.word() != "!!opencv-matrix") return input_error(key + ": not an opencv-matrix");
  Matrix matrix;
  while (!scanner.done())
    if (Expected<void> read = read_field(scanner, count, matrix); !read)
      return tl::unexpected(read.error().within(key));
  if (!matrix.rows || !matrix.columns || !matrix.typed || !matrix.data)
    return input_error(key + ": rows, cols, dt or data is missing");
  if (*matrix.rows != rows || *matrix.columns != columns || matrix.data->size() != count)
    return input_error(key + ": not a " + shape + " matrix");
  return std::move(*matrix.data);
}

std::string file_storage_sequence(std::string_view key, std::span<const int> values) {
  return std::string(key) + ": " + flow_sequence(values, ", ");
}

std::string file_storage_number(std::string_view key, double value) {
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  return std::string(key) + ": " + std::string(digits.data(), end) + "\n";
}

std::string file_storage_matrix(std::string_view key, int rows, int columns, std::span<const double> values) {
  return std::string(key) + ": !!opencv-matrix\n   rows: " + std::to_string(rows) +
         "\n   cols: " + std::to_string(columns) +
         "\n   dt: d\n   data: " + flow_sequence(values, ",\n       ");
}

}  // namespace bodyscan
