#include "pipeline/calibration/calibration_file.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto calibration = bodyscan::parse_calibration(text, "fuzz.yml");
  if (calibration && !bodyscan::check_calibration(*calibration)) std::abort();
  return 0;
}
