#include "tools/simulator/session_options.hpp"

#include "tools/simulator/option_range.hpp"
#include "tools/simulator/session_poses.hpp"

#include <array>
#include <charconv>
#include <string_view>
#include <utility>

namespace bodyscan::simulator {
namespace {

constexpr std::array<std::pair<std::string_view, Blunder>, 7> blunder_names{
    {{"cut", Blunder::cut},
     {"moved", Blunder::moved},
     {"blurred", Blunder::blurred},
     {"size", Blunder::size},
     {"scaled", Blunder::scaled},
     {"dark", Blunder::dark},
     {"overexposed", Blunder::overexposed}}};

}  // namespace

std::string name_of(Blunder kind) {
  for (const auto& [name, named] : blunder_names) {
    if (named == kind) return std::string(name);
  }
  return {};
}

Expected<PlantedBlunder> parse_blunder(const std::string& text) {
  PlantedBlunder blunder;
  const char* end = text.data() + text.size();
  const auto number = std::from_chars(text.data(), end, blunder.pose);
  if (number.ec == std::errc{} && number.ptr != end && *number.ptr == ':') {
    const std::string_view kind(number.ptr + 1, end);
    for (const auto& [name, named] : blunder_names) {
      if (name != kind) continue;
      blunder.kind = named;
      return blunder;
    }
  }
  std::string kinds;
  for (const auto& [name, named] : blunder_names) kinds += (kinds.empty() ? "" : ", ") + std::string(name);
  return usage_error("--blunder: \"" + text + "\" is no POSE:KIND (kinds: " + kinds + ")");
}

RenderOptions session_render_defaults() {
  RenderOptions options;
  options.light = 0.75;
  options.lens_blur = 0.7;
  return options;
}

Expected<void> SessionOptions::check() const {
  if (Expected<void> checked = render.check(); !checked) return checked;
  const double largest_bend = board.square_mm * (board.columns + 3) / 10;
  const Expected<void> in_range =
      check_ranges({{"--poses", static_cast<double>(poses), 1, most_session_poses},
                    {"--columns", static_cast<double>(board.columns), 3, 50},
                    {"--rows", static_cast<double>(board.rows), 3, 50},
                    {"--square-mm", board.square_mm, 0.1, 1000},
                    {"--bend", bend_mm, -largest_bend, largest_bend},
                    {"--plate", plate_mm, 0, 1000},
                    {"--projected-share", projected_share, smallest_projected_share, 1}});
  if (!in_range) return in_range;
  for (const PlantedBlunder& blunder : blunders) {
    if (blunder.pose < 0 || blunder.pose >= poses)
      return usage_error("--blunder: there is no pose " + std::to_string(blunder.pose) + " (0 to " +
                         std::to_string(poses - 1) + ")");
  }
  return {};
}

}  // namespace bodyscan::simulator
