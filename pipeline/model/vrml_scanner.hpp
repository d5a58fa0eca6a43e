#pragma once

#include "pipeline/base/error.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace bodyscan::vrml {

// Fills the buffer from the front and says how many bytes it got; 0 at the end of the text.
using Source = std::function<Expected<std::size_t>(std::span<char>)>;

// The lexical part of VRML97 (ISO/IEC 14772-1, clause 5.1 and annex A), read through a window of fixed size.
// White space, commas and comments between tokens are skipped. Every function that returns false has recorded
// an error; the first one stays, with the line it was met in.
class Scanner {
 public:
  explicit Scanner(Source source);

  // Consumes the first line; true if it is `#VRML V2.0 utf8`, alone or with a comment behind it.
  [[nodiscard]] bool header();

  // The first character of the next token, not consumed; 0 at the end of the text.
  [[nodiscard]] char peek();
  [[nodiscard]] bool at_end();
  [[nodiscard]] bool accept(char character);
  [[nodiscard]] bool expect(char character);

  // A name or keyword; the characters allowed are those of annex A.2, and the full stop of `ROUTE a.b TO
  // c.d`.
  [[nodiscard]] bool word(std::string& text);
  // A quoted string without its quotes and escapes.
  [[nodiscard]] bool string(std::string& text, std::size_t max_bytes);
  // A decimal number, finite as a float. A comma between two digits is refused as a decimal comma.
  [[nodiscard]] bool number(float& value);
  // A decimal integer.
  [[nodiscard]] bool integer(std::int32_t& value);
  // Whatever comes next that is no string and no bracket.
  [[nodiscard]] bool skip_token();

  [[nodiscard]] bool fail(std::string reason);  // in the current line
  [[nodiscard]] bool fail_in(std::size_t line, std::string reason);
  [[nodiscard]] std::size_t line() const { return line_; }
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

 private:
  bool refill();
  void ensure(std::size_t bytes);
  void skip_comment();
  [[nodiscard]] bool unexpected(std::string_view wanted);
  [[nodiscard]] bool ends_number(const char* end, bool comma_may_touch);
  [[nodiscard]] std::size_t left() const { return static_cast<std::size_t>(end_ - next_); }

  Source source_;
  std::unique_ptr<char[]> window_;  // a 0 follows the text in it
  const char* next_;
  const char* end_;
  std::size_t line_ = 1;
  bool exhausted_ = false;
  std::optional<Error> error_;
};

}  // namespace bodyscan::vrml
