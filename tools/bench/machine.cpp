#include "tools/bench/machine.hpp"

#include <array>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <thread>

#include <sys/utsname.h>
#include <unistd.h>

namespace bodyscan {
namespace {

// What follows `separator` on the first line that starts with `key`.
std::string value_in(const char* file, const std::string& key, char separator) {
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    const std::size_t place = line.find(separator);
    if (!line.starts_with(key) || place == std::string::npos) continue;
    const std::size_t begin = line.find_first_not_of(" \t\"", place + 1);
    const std::size_t end = line.find_last_not_of(" \t\"");
    return begin == std::string::npos ? "" : line.substr(begin, end - begin + 1);
  }
  return "unknown";
}

}  // namespace

std::string describe_machine() {
  utsname system{};
  uname(&system);
  const double memory_gib = static_cast<double>(sysconf(_SC_PHYS_PAGES)) *
                            static_cast<double>(sysconf(_SC_PAGESIZE)) / (1024.0 * 1024 * 1024);
  std::array<char, 64> size{};
  std::snprintf(size.data(), size.size(), ", %u threads, %.1f GiB; ", std::thread::hardware_concurrency(),
                memory_gib);
  return value_in("/proc/cpuinfo", "model name", ':') + size.data() +
         value_in("/etc/os-release", "PRETTY_NAME", '=') + ", Linux " + system.release;
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d", std::gmtime(&now));
  return text.data();
}

}  // namespace bodyscan
