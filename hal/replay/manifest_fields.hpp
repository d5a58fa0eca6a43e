#pragma once

#include "hal/replay/json_node.hpp"
#include "pipeline/base/image.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace bodyscan {

// What capture.json and session.json have in common.

// The keys "format" and "version" of a document of version 1.
Expected<void> check_format(const JsonNode& root, std::string_view format);

// An integer in `low` to `high`.
Expected<int> integer_between(const JsonNode& node, int low, int high);

// The object "projector": width and height.
Expected<Size> projector_size(const JsonNode& node);

// The name of something that lies in the same folder.
Expected<std::string> plain_name(const JsonNode& node);

// The document that `text` holds through `read`; `name` stands in front of messages.
template <class Read>
auto read_document(std::string_view text, const std::string& name, std::size_t max_bytes, Read read)
    -> decltype(read(JsonNode{})) {
  if (text.size() > max_bytes)
    return input_error(name + ": over the limit of " + std::to_string(max_bytes) + " bytes");
  return parse_json(text)
      .and_then([&](const nlohmann::json& document) {
        return read(JsonNode{&document, ""});
      })
      .map_error([&](const Error& error) { return error.within(name); });
}

}  // namespace bodyscan
