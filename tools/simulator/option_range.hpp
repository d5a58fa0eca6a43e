#pragma once

#include "pipeline/base/error.hpp"

#include <initializer_list>
#include <string>

namespace bodyscan::simulator {

// The number an option was given, and where it must lie.
struct OptionRange {
  const char* option;
  double value;
  double smallest;
  double largest;
};

// An error of kind `usage` that starts with the first option outside its range.
Expected<void> check_ranges(std::initializer_list<OptionRange> ranges);

[[nodiscard]] inline tl::unexpected<Error> usage_error(std::string message) {
  return tl::unexpected(Error{ErrorKind::usage, std::move(message)});
}

}  // namespace bodyscan::simulator
