#include "tools/simulator/option_range.hpp"

namespace bodyscan::simulator {
namespace {

std::string number(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

}  // namespace

Expected<void> check_ranges(std::initializer_list<OptionRange> ranges) {
  for (const OptionRange& range : ranges) {
    if (!(range.value >= range.smallest && range.value <= range.largest))
      return usage_error(std::string(range.option) + ": must lie in " + number(range.smallest) + " to " +
                         number(range.largest));
  }
  return {};
}

}  // namespace bodyscan::simulator
