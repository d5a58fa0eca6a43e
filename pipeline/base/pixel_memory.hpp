#pragma once

#include <cstddef>
#include <cstdlib>

namespace bodyscan {

// Uninitialised memory for a raster, at cache lines; a large one is asked for in huge pages, since touching
// 12 million pixels for the first time costs more in small ones than many a stage does. Throws
// std::bad_alloc.
void* allocate_pixels(std::size_t bytes);

struct FreePixels {
  void operator()(void* memory) const { std::free(memory); }
};

}  // namespace bodyscan
