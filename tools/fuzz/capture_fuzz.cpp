#include "hal/replay/capture_manifest.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

namespace {

using bodyscan::Axis;
using bodyscan::PatternKind;

// What is due next of an axis.
struct Due {
  int step = 0;
  int bit = -2;  // no bit yet
};

// What the parser promises of every manifest that it accepts.
bool keeps_promises(const bodyscan::CaptureManifest& manifest) {
  if (manifest.frames.size() < 3 || manifest.frames[0].pattern.kind != PatternKind::white ||
      manifest.frames[1].pattern.kind != PatternKind::black)
    return false;
  constexpr int unseen = -2;
  Due due[2];  // rows, columns
  for (std::size_t i = 2; i < manifest.frames.size(); ++i) {
    const bodyscan::Pattern& pattern = manifest.frames[i].pattern;
    const bool rows = pattern.axis == Axis::row;
    int& next = due[rows ? 0 : 1].bit;
    if (pattern.kind == PatternKind::phase) {
      if (next != unseen || pattern.step != due[rows ? 0 : 1].step++ || pattern.step >= pattern.steps)
        return false;
      continue;
    }
    if (pattern.kind != PatternKind::gray) return false;
    if (next == unseen)
      next = bodyscan::gray_bits(rows ? manifest.projector.height : manifest.projector.width) - 1;
    if (pattern.bit != (pattern.inverted ? next + 1 : next)) return false;
    if (!pattern.inverted) --next;
  }
  return std::all_of(
      manifest.frames.begin(), manifest.frames.end(), [](const bodyscan::ManifestFrame& frame) {
        return !frame.file.empty() && frame.file.find('/') == std::string::npos && frame.file != "..";
      });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto manifest = bodyscan::parse_manifest(text, "fuzz.json");
  if (manifest && !keeps_promises(*manifest)) std::abort();
  return 0;
}
