#pragma once

#include "pipeline/base/image.hpp"

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace bodyscan::gphoto2 {

// The texts that libgphoto2 gives a camera's choices. Nothing where the text means something else ("Bulb",
// "Auto", "implicit auto").
std::optional<double> exposure_seconds(std::string_view text);  // "1/20", "10/13", "0.0500s", "1/20s", "2"
std::optional<double> f_number(std::string_view text);          // "f/8", "f/3.8", "8"
std::optional<double> iso(std::string_view text);               // "200"
std::optional<double> percent(std::string_view text);           // "87%"
std::optional<Size> picture_size(std::string_view text);        // "4288x2848"

// The choice whose meaning is nearest to `wanted` as a ratio; nothing where no choice means a number.
std::optional<std::string> nearest_choice(
    const std::vector<std::string>& choices, double wanted,
    const std::function<std::optional<double>(std::string_view)>& meaning);

// The JPEG of the best quality, without a raw picture beside it: "JPEG Fine", "Large Fine JPEG".
std::optional<std::string> best_jpeg(const std::vector<std::string>& choices);

}  // namespace bodyscan::gphoto2
