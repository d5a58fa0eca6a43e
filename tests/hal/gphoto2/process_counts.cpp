#include "process_counts.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <unistd.h>

namespace bodyscan::gphoto2 {
namespace {

std::size_t entries(const char* folder) {
  return static_cast<std::size_t>(
      std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator()));
}

}  // namespace

std::size_t open_descriptors() {
  return entries("/proc/self/fd");
}

std::size_t child_processes() {
  std::size_t count = 0;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::ifstream children(task.path() / "children");
    count += static_cast<std::size_t>(
        std::distance(std::istream_iterator<std::string>(children), std::istream_iterator<std::string>()));
  }
  return count;
}

}  // namespace bodyscan::gphoto2
