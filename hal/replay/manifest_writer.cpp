#include "hal/replay/capture_manifest.hpp"
#include "pipeline/base/atomic_file.hpp"

#include <nlohmann/json.hpp>

namespace bodyscan {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const ManifestFrame& frame) {
  Json json{{"file", frame.file}};
  const Pattern& pattern = frame.pattern;
  const char* axis = pattern.axis == Axis::row ? "row" : "column";
  switch (pattern.kind) {
    case PatternKind::white:
      json["pattern"] = "white";
      break;
    case PatternKind::black:
      json["pattern"] = "black";
      break;
    case PatternKind::gray:
      json["pattern"] = "gray";
      json["axis"] = axis;
      json["bit"] = pattern.bit;
      json["inverted"] = pattern.inverted;
      break;
    case PatternKind::phase:
      json["pattern"] = "phase";
      json["axis"] = axis;
      json["period_px"] = pattern.period_px;
      json["step"] = pattern.step;
      json["steps"] = pattern.steps;
      break;
  }
  if (frame.timestamp_us) json["timestamp_us"] = *frame.timestamp_us;
  return json;
}

Json json_of(const CaptureManifest& manifest) {
  Json json{{"format", "bodyscan-capture"}, {"version", 1}};
  json["projector"] = {{"width", manifest.projector.width}, {"height", manifest.projector.height}};
  if (manifest.response) {
    switch (manifest.response->kind) {
      case ToneResponse::Kind::srgb:
        json["response"] = "srgb";
        break;
      case ToneResponse::Kind::linear:
        json["response"] = "linear";
        break;
      case ToneResponse::Kind::gamma:
        json["response"] = manifest.response->gamma;
        break;
    }
  }
  if (manifest.camera) json["camera"] = *manifest.camera;
  if (manifest.exposure_us) json["exposure_us"] = *manifest.exposure_us;
  if (manifest.iso) json["iso"] = *manifest.iso;
  if (manifest.aperture) json["aperture"] = *manifest.aperture;
  if (manifest.captured_at) json["captured_at"] = *manifest.captured_at;
  json["frames"] = Json::array();
  for (const ManifestFrame& frame : manifest.frames) json["frames"].push_back(json_of(frame));
  return json;
}

}  // namespace

Expected<void> write_manifest(const CaptureManifest& manifest, const std::filesystem::path& path) {
  // Text that is not UTF-8 must not throw here; a reader sees the replacement character.
  const std::string text = json_of(manifest).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  Expected<AtomicFile> file = AtomicFile::create(path);
  if (!file) return tl::unexpected(file.error());
  if (Expected<void> written = file->write(text); !written) return written;
  return file->commit(Durability::process);
}

}  // namespace bodyscan
