#pragma once

#include "pipeline/base/error.hpp"
#include "tools/simulator/subject.hpp"

#include <filesystem>

namespace bodyscan::simulator {

// A Wavefront OBJ file (mm, y up, z towards the viewer) as a subject whose origin is the centre of its
// bounding box. Read: v (with or without sRGB colours 0..1), vt, vn, f (polygons are fanned, negative indices
// count from the end), mtllib, usemtl, and of the materials Kd and map_Kd (JPEG or PNG). Other statements are
// skipped. Limit: 2^26 faces. Errors name the file and the line.
Expected<Subject> read_obj(const std::filesystem::path& path);

}  // namespace bodyscan::simulator
