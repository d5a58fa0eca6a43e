#pragma once

#include "tools/simulator/image_files.hpp"
#include "tools/simulator/render_options.hpp"

#include <string>

namespace bodyscan::simulator {

// With the folders above it; no error where it exists.
Expected<void> make_folder(const std::filesystem::path& folder);

// ".jpg" or ".png".
std::string extension(FrameFormat format);

// A frame in the options' format and quality; the path carries the extension.
Expected<void> write_frame(const std::filesystem::path& path, const ColorImage8& image,
                           const RenderOptions& options);

}  // namespace bodyscan::simulator
