#include "app/scan/kept_photographs.hpp"

#include "hal/replay/capture_manifest.hpp"
#include "pipeline/base/atomic_file.hpp"

#include <array>
#include <cstdio>
#include <string>
#include <system_error>

namespace bodyscan {
namespace {

// PNG's signature begins with a byte that is not ASCII; a camera writes JPEG else.
const char* extension_of(const Photograph& photograph) {
  return !photograph.file.empty() && photograph.file[0] == std::byte{0x89} ? "png" : "jpg";
}

std::string name_of(std::size_t index, const Photograph& photograph) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "frame_%02zu.%s", index, extension_of(photograph));
  return name.data();
}

Expected<void> write(const std::filesystem::path& path, const Photograph& photograph) {
  Expected<AtomicFile> file = AtomicFile::create(path);
  if (!file) return tl::unexpected(file.error());
  return file->write({reinterpret_cast<const char*>(photograph.file.data()), photograph.file.size()})
      .and_then([&] { return file->commit(Durability::process); });
}

}  // namespace

Expected<void> keep_photographs(const std::filesystem::path& folder, const PatternSequence& sequence,
                                const LiveDecoder& decoder, const CameraIdentity& camera,
                                const CameraSettings& settings) {
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (code) return output_error(folder.string() + ": " + code.message());
  CaptureManifest manifest;
  manifest.projector = sequence.projector;
  manifest.camera = camera.model;
  manifest.exposure_us = settings.exposure_us;
  manifest.iso = settings.iso;
  manifest.aperture = settings.aperture;
  for (std::size_t i = 0; i < sequence.patterns.size(); ++i) {
    const Photograph& photograph = decoder.photograph(static_cast<int>(i));
    const std::string name = name_of(i, photograph);
    if (Expected<void> written = write(folder / name, photograph); !written) return written;
    manifest.frames.push_back({name, sequence.patterns[i], photograph.exposure_end_us});
  }
  return write_manifest(manifest, folder / "capture.json");
}

}  // namespace bodyscan
