#pragma once

#include <cstddef>

namespace bodyscan::gphoto2 {

std::size_t open_descriptors();

// Of this process: running, stopped or zombies.
std::size_t child_processes();

}  // namespace bodyscan::gphoto2
