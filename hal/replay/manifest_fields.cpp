#include "hal/replay/manifest_fields.hpp"

#include <algorithm>

namespace bodyscan {
namespace {

constexpr int max_projector_side = 1 << 15;

Expected<int> projector_side(const JsonNode& node) {
  return integer_between(node, 2, max_projector_side);
}

bool is_plain_name(std::string_view name) {
  const bool control = std::any_of(name.begin(), name.end(), [](char c) { return c >= 0 && c < ' '; });
  return !name.empty() && name != "." && name != ".." && !control &&
         name.find_first_of("/\\") == std::string_view::npos;
}

}  // namespace

Expected<void> check_format(const JsonNode& root, std::string_view format) {
  if (!root.value->is_object()) return input_error("not a JSON object");
  const Expected<std::string> found = required(root, "format", json_text);
  if (!found) return tl::unexpected(found.error());
  if (*found != format) return input_error("format: \"" + *found + "\" is not " + std::string(format));
  const Expected<std::int64_t> version = required(root, "version", json_integer);
  if (!version) return tl::unexpected(version.error());
  if (*version != 1) return input_error("version: " + std::to_string(*version) + " is not 1");
  return {};
}

Expected<int> integer_between(const JsonNode& node, int low, int high) {
  return json_integer(node).and_then([&](std::int64_t value) -> Expected<int> {
    if (value < low || value > high)
      return node.error(std::to_string(value) + " does not lie in " + std::to_string(low) + " to " +
                        std::to_string(high));
    return static_cast<int>(value);
  });
}

Expected<Size> projector_size(const JsonNode& node) {
  if (!node.value->is_object()) return node.error("not an object");
  const Expected<int> width = required(node, "width", projector_side);
  if (!width) return tl::unexpected(width.error());
  const Expected<int> height = required(node, "height", projector_side);
  if (!height) return tl::unexpected(height.error());
  return Size{*width, *height};
}

Expected<std::string> plain_name(const JsonNode& node) {
  Expected<std::string> name = json_text(node);
  if (name && !is_plain_name(*name)) return node.error("not a plain file name inside the folder");
  return name;
}

}  // namespace bodyscan
