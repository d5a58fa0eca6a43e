#pragma once

#include "pipeline/model/mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace bodyscan::vrml {

// Coordinates are written in steps of 0.0001 mm, a hundredth of what the scanner resolves; farther away than
// this they are refused.
inline constexpr float max_coordinate_mm = 100000;

// Bytes that one item takes at most, its line break included.
inline constexpr std::size_t max_point_bytes = 3 * 13;
inline constexpr std::size_t max_color_bytes = 3 * 6;
inline constexpr std::size_t max_face_bytes = 3 * 11 + 3;

// Where formatting ended: `bytes` were written for the first `items` items; fewer items than given means that
// the next one cannot be written (a coordinate that is not finite or too far away; a face with an index that
// is not below `point_count`, or the same one twice).
struct Formatted {
  std::size_t items = 0;
  std::size_t bytes = 0;
};

// One item a line, numbers without superfluous zeros. `out` has room for items.size() times the bytes above.
Formatted format_points(std::span<const Point3f> points, char* out);  // rounded to 0.0001 mm
Formatted format_colors(std::span<const Rgb8> colors, char* out);     // 0..1, three digits: exact for 8 bits
Formatted format_faces(std::span<const Face> faces, std::uint32_t point_count, char* out);

// `text` as a VRML string with its quotes. What readers trip over is replaced: double by single quotes and
// backslashes by slashes (VTK 9.1 knows no escapes), control characters by spaces, what is not UTF-8 by '?'.
std::string quoted(std::string_view text);

}  // namespace bodyscan::vrml
