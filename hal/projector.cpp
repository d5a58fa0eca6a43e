#include "hal/projector.hpp"

#include <cstdio>

namespace bodyscan {

std::string describe(const DisplayMode& mode) {
  char text[64];
  std::snprintf(text, sizeof text, "%d x %d at %.4g Hz", mode.size.width, mode.size.height, mode.refresh_hz);
  return text;
}

}  // namespace bodyscan
