#pragma once

#include <string_view>

namespace bodyscan {

// "bodyscan 0.1.0+0123456789": the project's version and the commit it was built from.
std::string_view software_version();

}  // namespace bodyscan
