#pragma once

#include <string>

namespace bodyscan {

// "AMD EPYC ..., 2 threads, 23.4 GiB; Debian GNU/Linux 12 (bookworm), Linux 6.1.0" of the running machine.
std::string describe_machine();

// Today, UTC: "2026-01-31".
std::string today();

}  // namespace bodyscan
