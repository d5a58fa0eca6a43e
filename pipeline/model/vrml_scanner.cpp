#include "pipeline/model/vrml_scanner.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <utility>

namespace bodyscan::vrml {
namespace {

constexpr std::size_t window_bytes = std::size_t{1} << 16;
constexpr std::size_t max_number_bytes = 64;
constexpr std::size_t max_word_bytes = 256;

constexpr std::array<double, 16> powers_of_ten = {1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                  1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};

enum Trait : std::uint8_t { digit = 1, space = 2, token_end = 4, word_part = 8 };

constexpr std::array<std::uint8_t, 256> traits = [] {
  std::array<std::uint8_t, 256> table{};
  for (unsigned i = 0; i < 256; ++i) {
    const char c = static_cast<char>(i);
    const bool blank = c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == ',';
    const bool ends = blank || std::string_view("[]{}#\"").find(c) != std::string_view::npos || i == 0;
    const bool in_word = i > 0x20 && i != 0x7F && c != '\'' && c != '\\' && !ends;
    table[i] = static_cast<std::uint8_t>((c >= '0' && c <= '9' ? digit : 0) | (blank ? space : 0) |
                                         (ends ? token_end : 0) | (in_word ? word_part : 0));
  }
  return table;
}();

bool has(char character, Trait trait) {
  return (traits[static_cast<unsigned char>(character)] & trait) != 0;
}
bool is_digit(char character) {
  return has(character, digit);
}

std::string named(char character) {
  if (character > 0x20 && character < 0x7F) return std::string("'") + character + "'";
  return "byte " + std::to_string(static_cast<unsigned char>(character));
}

}  // namespace

Scanner::Scanner(Source source)
    : source_(std::move(source)),
      window_(std::make_unique_for_overwrite<char[]>(window_bytes + 1)),
      next_(window_.get()),
      end_(next_) {
  window_[0] = '\0';
}

// Moves what is left to the front and reads more behind it; false if there is no more.
bool Scanner::refill() {
  if (exhausted_) return false;
  const std::size_t kept = left();
  std::memmove(window_.get(), next_, kept);
  next_ = window_.get();
  end_ = next_ + kept;
  Expected<std::size_t> count = source_({window_.get() + kept, window_bytes - kept});
  if (!count && !error_) error_ = count.error();
  exhausted_ = !count || *count == 0;
  end_ += count.value_or(0);
  window_[left()] = '\0';
  return !exhausted_;
}

void Scanner::ensure(std::size_t bytes) {
  while (left() < bytes && refill()) {
  }
}

bool Scanner::fail_in(std::size_t line, std::string reason) {
  if (!error_) error_ = Error{ErrorKind::input, "line " + std::to_string(line) + ": " + std::move(reason)};
  return false;
}

bool Scanner::fail(std::string reason) {
  return fail_in(line_, std::move(reason));
}

bool Scanner::unexpected(std::string_view wanted) {
  const char found = peek();
  return fail((at_end() ? "the file ends" : named(found) + " found") + " where " + std::string(wanted) +
              " is due");
}

bool Scanner::header() {
  constexpr std::string_view magic = "#VRML V2.0 utf8";
  ensure(magic.size() + 1);
  const std::string_view start(next_, left());
  if (start.starts_with("\xEF\xBB\xBF")) return fail("a byte order mark before the header");
  const bool ends = start.size() <= magic.size() ||
                    std::string_view(" \t\r\n").find(start[magic.size()]) != std::string_view::npos;
  if (!start.starts_with(magic) || !ends) {
    return fail("the first line is not \"#VRML V2.0 utf8\"");
  }
  skip_comment();
  return true;
}

void Scanner::skip_comment() {
  for (;;) {
    while (next_ != end_ && *next_ != '\n' && *next_ != '\r') ++next_;
    if (next_ != end_ || !refill()) return;
  }
}

char Scanner::peek() {
  for (;;) {
    const char character = *next_;
    if (character == '\n') {
      ++line_;
      ++next_;
    } else if (has(character, space)) {
      ++next_;
    } else if (character == '#') {
      skip_comment();
    } else if (character != '\0' || next_ != end_ || !refill()) {
      return character;
    }
  }
}

bool Scanner::at_end() {
  return peek() == '\0' && left() == 0;
}

bool Scanner::accept(char character) {
  if (peek() != character) return false;
  ++next_;
  return true;
}

bool Scanner::expect(char character) {
  return accept(character) || unexpected(named(character));
}

bool Scanner::word(std::string& text) {
  const char first = peek();
  if (!has(first, word_part) || is_digit(first) || first == '+' || first == '-' || first == '.') {
    return unexpected("a name");
  }
  ensure(max_word_bytes + 1);
  const char* last = next_;
  while (has(*last, word_part)) ++last;
  if (static_cast<std::size_t>(last - next_) > max_word_bytes) return fail("a name of more than 256 bytes");
  text.assign(next_, last);
  next_ = last;
  return true;
}

bool Scanner::string(std::string& text, std::size_t max_bytes) {
  if (peek() != '"') return unexpected("a string");
  const std::size_t first_line = line_;
  ++next_;
  text.clear();
  for (bool escaped = false;; ++next_) {
    if (next_ == end_ && !refill()) return fail_in(first_line, "a string without end");
    const char character = *next_;
    if (character == '\n') ++line_;
    if (!escaped && character == '"') break;
    escaped = !escaped && character == '\\';
    if (escaped) continue;
    if (text.size() == max_bytes) {
      return fail("a string of more than " + std::to_string(max_bytes) + " bytes");
    }
    text += character;
  }
  ++next_;
  return true;
}

bool Scanner::ends_number(const char* end, bool comma_may_touch) {
  if (!has(*end, token_end) || *end == '#') return fail(named(*end) + " in a number");
  if (*end == ',' && is_digit(end[1]) && !comma_may_touch) return fail("a decimal comma");
  next_ = end;
  return true;
}

bool Scanner::number(float& value) {
  const char sign = peek();
  ensure(max_number_bytes);
  const char* first = next_ + (sign == '-' || sign == '+' ? 1 : 0);
  if (!is_digit(*first) && !(*first == '.' && is_digit(first[1]))) return unexpected("a number");

  // Up to 15 digits without an exponent: digits and power of ten are exact in double (Clinger 1990).
  std::uint64_t digits = 0;
  const char* last = first;
  for (; is_digit(*last); ++last) digits = digits * 10 + static_cast<unsigned>(*last - '0');
  std::size_t decimals = 0;
  if (*last == '.') {
    const char* point = last++;
    for (; is_digit(*last); ++last) digits = digits * 10 + static_cast<unsigned>(*last - '0');
    decimals = static_cast<std::size_t>(last - point - 1);
  }
  if (last - first <= 15 && *last != 'e' && *last != 'E') {
    const auto magnitude = static_cast<float>(static_cast<double>(digits) / powers_of_ten[decimals]);
    value = sign == '-' ? -magnitude : magnitude;
    return ends_number(last, false);
  }
  const auto result = std::from_chars(first, std::min(end_, first + max_number_bytes), value);
  if (result.ec != std::errc{}) return fail("a number out of range");
  if (sign == '-') value = -value;
  return ends_number(result.ptr, false);
}

bool Scanner::integer(std::int32_t& value) {
  const char sign = peek();
  ensure(max_number_bytes);
  const char* first = next_ + (sign == '-' || sign == '+' ? 1 : 0);
  if (!is_digit(*first)) return unexpected("an integer");
  std::uint64_t digits = 0;
  const char* last = first;
  for (; is_digit(*last); ++last) digits = digits * 10 + static_cast<unsigned>(*last - '0');
  if (last - first > 10 || digits > 0x7FFFFFFF) return fail("an integer out of range");
  value = static_cast<std::int32_t>(digits);
  if (sign == '-') value = -value;
  return ends_number(last, true);
}

bool Scanner::skip_token() {
  if (has(peek(), token_end)) return unexpected("a value");
  for (;;) {
    while (!has(*next_, token_end)) ++next_;
    if (next_ != end_ || !refill()) return true;
  }
}

}  // namespace bodyscan::vrml
