#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/image/tone_response.hpp"
#include "pipeline/pattern/sequence.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace bodyscan {

struct ManifestFrame {
  std::string file;  // a plain name inside the capture folder
  Pattern pattern;
  std::optional<std::int64_t> timestamp_us;
};

// capture.json: which picture shows which pattern. Complete: white, black, and for each axis that occurs
// every bit once, with all the inverses or none, or every phase step and the coarser bits.
struct CaptureManifest {
  Size projector;
  std::vector<ManifestFrame> frames;     // in decode order, see parse_manifest
  std::optional<ToneResponse> response;  // key "response": "srgb", "linear" or a number, the gamma
  std::optional<std::string> camera;
  std::optional<double> exposure_us;
  std::optional<double> iso;
  std::optional<double> aperture;
  std::optional<std::string> captured_at;  // ISO 8601, UTC; the text is not interpreted
};

constexpr std::size_t max_manifest_bytes = std::size_t{1} << 20;

// `name` stands in front of messages: "capture.json: frames[3].bit: 12 does not exist for 768 rows". Frames
// come out in decode order whatever the text's: white, black, rows, columns; within an axis phase
// steps, then the coarsest bit first, each pattern before its inverse. Where "inverted" is not given it is
// false; unknown keys are ignored.
Expected<CaptureManifest> parse_manifest(std::string_view text, const std::string& name);

// The file, overwriting one of that name; frames in the given order.
Expected<void> write_manifest(const CaptureManifest& manifest, const std::filesystem::path& path);

}  // namespace bodyscan
