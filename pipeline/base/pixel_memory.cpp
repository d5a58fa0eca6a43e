#include "pipeline/base/pixel_memory.hpp"

#include <new>

#include <sys/mman.h>

namespace bodyscan {

void* allocate_pixels(std::size_t bytes) {
  constexpr std::size_t cache_line = 64;
  constexpr std::size_t huge_page = std::size_t{2} << 20;
  const std::size_t alignment = bytes >= 2 * huge_page ? huge_page : cache_line;
  const std::size_t rounded = (bytes + cache_line - 1) / cache_line * cache_line;
  if (rounded < bytes) throw std::bad_alloc();
  void* memory = nullptr;
  if (posix_memalign(&memory, alignment, rounded > 0 ? rounded : cache_line) != 0) throw std::bad_alloc();
  // Advice only: without huge pages all works the same.
  if (alignment == huge_page) madvise(memory, rounded / huge_page * huge_page, MADV_HUGEPAGE);
  return memory;
}

}  // namespace bodyscan
