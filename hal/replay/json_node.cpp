#include "hal/replay/json_node.hpp"

#include <set>
#include <vector>

namespace bodyscan {

Expected<nlohmann::json> parse_json(std::string_view text) try {
  std::vector<std::set<std::string>> open_objects;
  std::optional<std::string> repeated;
  using Event = nlohmann::json::parse_event_t;
  auto document = nlohmann::json::parse(text, [&](int, Event event, const nlohmann::json& parsed) {
    if (event == Event::object_start) open_objects.emplace_back();
    if (event == Event::object_end) open_objects.pop_back();
    if (event == Event::key && !open_objects.back().insert(parsed.get<std::string>()).second && !repeated)
      repeated = parsed.get<std::string>();
    return true;
  });
  if (repeated) return input_error("the key \"" + *repeated + "\" occurs twice in one object");
  return document;
} catch (const nlohmann::json::exception& failure) {
  const std::string_view what = failure.what();  // "[json.exception.parse_error.101] parse error at line ..."
  const std::size_t prefix = what.find("] ");
  return input_error(std::string(prefix == std::string_view::npos ? what : what.substr(prefix + 2)));
}

}  // namespace bodyscan
