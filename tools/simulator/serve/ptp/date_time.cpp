#include "tools/simulator/serve/ptp/date_time.hpp"

#include <array>
#include <ctime>

namespace bodyscan::simulator::ptp {

std::string date_time_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  localtime_r(&now, &parts);
  std::array<char, 20> text{};
  return {text.data(), std::strftime(text.data(), text.size(), "%Y%m%dT%H%M%S", &parts)};
}

}  // namespace bodyscan::simulator::ptp
