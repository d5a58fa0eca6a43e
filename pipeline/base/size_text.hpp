#pragma once

#include "pipeline/base/image.hpp"

#include <string>

namespace bodyscan {

// "4288 x 2848", for messages.
inline std::string text_of(Size size) {
  return std::to_string(size.width) + " x " + std::to_string(size.height);
}

}  // namespace bodyscan
