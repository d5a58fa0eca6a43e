#include "hal/replay/capture_manifest.hpp"

#include "hal/replay/manifest_fields.hpp"
#include "hal/replay/sequence_check.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace bodyscan {
namespace {

Expected<Axis> axis(const JsonNode& node) {
  return json_text(node).and_then([&](const std::string& name) -> Expected<Axis> {
    if (name == "row") return Axis::row;
    if (name == "column") return Axis::column;
    return node.error("\"" + name + "\" is neither row nor column");
  });
}

Expected<Pattern> gray_pattern(const JsonNode& frame, Size projector) {
  Pattern pattern{.kind = PatternKind::gray};
  const Expected<Axis> along = required(frame, "axis", axis);
  if (!along) return tl::unexpected(along.error());
  pattern.axis = *along;

  const Expected<JsonNode> bit_node = frame.member("bit");
  const Expected<std::int64_t> bit = bit_node.and_then(json_integer);
  if (!bit) return tl::unexpected(bit.error());
  const int count = count_along(*along, projector);
  if (*bit < 0 || *bit >= gray_bits(count))
    return bit_node->error(std::to_string(*bit) + " does not exist for " + std::to_string(count) +
                           (*along == Axis::row ? " rows" : " columns"));
  pattern.bit = static_cast<int>(*bit);

  if (frame.has("inverted")) {
    const Expected<bool> inverted = json_boolean(frame.optional("inverted"));
    if (!inverted) return tl::unexpected(inverted.error());
    pattern.inverted = *inverted;
  }
  return pattern;
}

Expected<Pattern> phase_pattern(const JsonNode& frame) {
  Pattern pattern{.kind = PatternKind::phase};
  const Expected<Axis> along = required(frame, "axis", axis);
  if (!along) return tl::unexpected(along.error());
  pattern.axis = *along;
  const auto integer = [&](const char* key, int low, int high, int& target) -> Expected<void> {
    return required(frame, key, [&](const JsonNode& node) { return integer_between(node, low, high); })
        .map([&](int value) { target = value; });
  };
  constexpr int most = PhaseCode::max_period;
  if (auto read = integer("period_px", 3, most, pattern.period_px); !read)
    return tl::unexpected(read.error());
  if (auto read = integer("steps", 3, most, pattern.steps); !read) return tl::unexpected(read.error());
  if (auto read = integer("step", 0, pattern.steps - 1, pattern.step); !read)
    return tl::unexpected(read.error());
  if (pattern.period_px % pattern.steps != 0)
    return frame.optional("steps").error(std::to_string(pattern.steps) + " does not divide the period of " +
                                         std::to_string(pattern.period_px));
  return pattern;
}

Expected<Pattern> pattern_of(const JsonNode& frame, Size projector) {
  const Expected<JsonNode> node = frame.member("pattern");
  const Expected<std::string> name = node.and_then(json_text);
  if (!name) return tl::unexpected(name.error());
  if (*name == "white") return Pattern{.kind = PatternKind::white};
  if (*name == "black") return Pattern{.kind = PatternKind::black};
  if (*name == "gray") return gray_pattern(frame, projector);
  if (*name == "phase") return phase_pattern(frame);
  return node->error("\"" + *name + "\" is not a pattern that can be decoded (white, black, gray, phase)");
}

Expected<ManifestFrame> frame_of(const JsonNode& node, Size projector) {
  if (!node.value->is_object()) return node.error("not an object");
  ManifestFrame frame;
  Expected<std::string> file = required(node, "file", plain_name);
  if (!file) return tl::unexpected(file.error());
  frame.file = std::move(*file);
  const Expected<Pattern> pattern = pattern_of(node, projector);
  if (!pattern) return tl::unexpected(pattern.error());
  frame.pattern = *pattern;
  if (Expected<void> read = read_if_present(node, "timestamp_us", json_integer, frame.timestamp_us); !read)
    return tl::unexpected(read.error());
  return frame;
}

// The axis's phase steps come before its bits.
auto decode_order(const Pattern& pattern) {
  const bool striped = pattern.kind == PatternKind::gray || pattern.kind == PatternKind::phase;
  const auto kind = striped ? PatternKind::gray : pattern.kind;
  return std::tuple(kind, pattern.axis, pattern.kind == PatternKind::gray, pattern.step, -pattern.bit,
                    pattern.inverted);
}

Expected<std::vector<ManifestFrame>> frames_of(const JsonNode& node, Size projector) {
  if (!node.value->is_array()) return node.error("not an array");
  std::vector<ManifestFrame> frames;
  for (std::size_t i = 0; i < node.value->size(); ++i) {
    const JsonNode item{&(*node.value)[i], node.place + "[" + std::to_string(i) + "]"};
    Expected<ManifestFrame> frame = frame_of(item, projector);
    if (!frame) return tl::unexpected(frame.error());
    const auto same = std::find_if(frames.begin(), frames.end(),
                                   [&](const ManifestFrame& f) { return f.pattern == frame->pattern; });
    if (same != frames.end())
      return item.error(describe(frame->pattern) + " again, after frames[" +
                        std::to_string(same - frames.begin()) + "]");
    frames.push_back(std::move(*frame));
  }
  std::sort(frames.begin(), frames.end(), [](const ManifestFrame& a, const ManifestFrame& b) {
    return decode_order(a.pattern) < decode_order(b.pattern);
  });
  return frames;
}

Expected<ToneResponse> response_of(const JsonNode& node) {
  using Kind = ToneResponse::Kind;
  if (node.value->is_number())
    return json_positive(node).map([](double gamma) { return ToneResponse{Kind::gamma, gamma}; });
  const auto name = json_text(node).value_or("");
  if (name == "srgb") return ToneResponse{Kind::srgb};
  if (name == "linear") return ToneResponse{Kind::linear};
  return node.error("neither \"srgb\", \"linear\" nor a gamma");
}

Expected<void> read_optional_keys(const JsonNode& root, CaptureManifest& manifest) {
  const Expected<void> good = {};
  if (root.has("response")) {
    const Expected<ToneResponse> response = response_of(root.optional("response"));
    if (!response) return tl::unexpected(response.error());
    manifest.response = *response;
  }
  return good.and_then([&] { return read_if_present(root, "camera", json_text, manifest.camera); })
      .and_then([&] { return read_if_present(root, "exposure_us", json_positive, manifest.exposure_us); })
      .and_then([&] { return read_if_present(root, "iso", json_positive, manifest.iso); })
      .and_then([&] { return read_if_present(root, "aperture", json_positive, manifest.aperture); })
      .and_then([&] { return read_if_present(root, "captured_at", json_text, manifest.captured_at); });
}

Expected<CaptureManifest> manifest_of(const JsonNode& root) {
  if (Expected<void> format = check_format(root, "bodyscan-capture"); !format)
    return tl::unexpected(format.error());
  CaptureManifest manifest;
  const Expected<Size> projector = required(root, "projector", projector_size);
  if (!projector) return tl::unexpected(projector.error());
  manifest.projector = *projector;
  Expected<std::vector<ManifestFrame>> frames =
      required(root, "frames", [&](const JsonNode& node) { return frames_of(node, *projector); });
  if (!frames) return tl::unexpected(frames.error());
  manifest.frames = std::move(*frames);
  if (Expected<void> complete = check_sequence(manifest.frames, *projector); !complete)
    return tl::unexpected(complete.error());
  if (Expected<void> read = read_optional_keys(root, manifest); !read) return tl::unexpected(read.error());
  return manifest;
}

}  // namespace

Expected<CaptureManifest> parse_manifest(std::string_view text, const std::string& name) {
  return read_document(text, name, max_manifest_bytes, manifest_of);
}

}  // namespace bodyscan
