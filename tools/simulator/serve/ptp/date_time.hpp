#pragma once

#include <string>

namespace bodyscan::simulator::ptp {

// The local time as PTP writes it, "YYYYMMDDThhmmss" (ISO 15740, 5.3.5.2).
std::string date_time_now();

}  // namespace bodyscan::simulator::ptp
