#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/model/mesh.hpp"
#include "pipeline/model/model_info.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>

namespace bodyscan {

// What a file may hold at most; beyond it is an error. The defaults leave a factor of four above a scan of 24
// megapixels.
struct VrmlLimits {
  std::uint64_t file_bytes = std::uint64_t{8} << 30;
  std::size_t points = 100'000'000;
  std::size_t faces = 200'000'000;
  std::size_t string_bytes = 65536;
  int nesting = 32;  // braces and brackets
};

struct VrmlModel {
  Mesh mesh;
  ModelInfo info;
};

// Reads the one IndexedFaceSet or PointSet of a VRML97 file, in the coordinates of its Coordinate node: mm
// for models written here. Transforms are not applied. Polygons become fans, `ccw FALSE` is turned round,
// nodes and fields of other kinds are skipped. Refused, with the line: prototypes, USE, a second geometry,
// colours that are not one a point, a point or face beyond the limits, a polygon not ended by -1, with fewer
// than three points or one twice in a row, an index without a point, decimal commas, numbers that are not
// finite, and whatever does not end properly. Errors are of kind `input`. Memory: the mesh and 256 KiB.
[[nodiscard]] Expected<VrmlModel> read_model(const std::filesystem::path& path,
                                             const VrmlLimits& limits = {});

// The same from memory.
[[nodiscard]] Expected<VrmlModel> parse_model(std::string_view text, const VrmlLimits& limits = {});

}  // namespace bodyscan
