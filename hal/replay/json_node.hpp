#pragma once

#include "pipeline/base/error.hpp"

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

namespace bodyscan {

// The document, or why it is none, with line and column. A key that occurs twice in an object is an error,
// where the library would keep the last without a word.
Expected<nlohmann::json> parse_json(std::string_view text);

// A value in the document and where it stands, for messages. Reading never throws.
struct JsonNode {
  const nlohmann::json* value;
  std::string place;

  [[nodiscard]] tl::unexpected<Error> error(const std::string& reason) const {
    return input_error(place + ": " + reason);
  }
  [[nodiscard]] bool has(const char* key) const { return value->contains(key); }
  [[nodiscard]] JsonNode optional(const char* key) const {
    return {&(*value)[key], place.empty() ? key : place + "." + key};
  }
  [[nodiscard]] Expected<JsonNode> member(const char* key) const {
    const std::string where = place.empty() ? key : place + "." + key;
    if (!value->contains(key)) return input_error(where + ": missing");
    return JsonNode{&(*value)[key], where};
  }
};

inline Expected<std::int64_t> json_integer(const JsonNode& node) {
  const bool fits = node.value->is_number_integer() &&
                    (!node.value->is_number_unsigned() || node.value->get<std::uint64_t>() <= INT64_MAX);
  if (!fits) return node.error("not an integer");
  return node.value->get<std::int64_t>();
}

inline Expected<std::string> json_text(const JsonNode& node) {
  if (!node.value->is_string()) return node.error("not a string");
  return node.value->get<std::string>();
}

inline Expected<bool> json_boolean(const JsonNode& node) {
  if (!node.value->is_boolean()) return node.error("not true or false");
  return node.value->get<bool>();
}

inline Expected<double> json_positive(const JsonNode& node) {
  if (!node.value->is_number()) return node.error("not a number");
  const double number = node.value->get<double>();
  if (!std::isfinite(number) || number <= 0) return node.error("must be positive");
  return number;
}

// The member `key` through `read`.
template <class Read>
auto required(const JsonNode& node, const char* key, Read read) -> decltype(read(node)) {
  return node.member(key).and_then(read);
}

// The same into `target` if there is one.
template <class Read, class Value>
inline Expected<void> read_if_present(const JsonNode& node, const char* key, Read read,
                                      std::optional<Value>& target) {
  if (!node.has(key)) return {};
  return read(node.optional(key)).map([&](Value value) { target = std::move(value); });
}

}  // namespace bodyscan
