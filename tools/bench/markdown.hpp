#pragma once

#include "pipeline/base/error.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace bodyscan {

// Lines of a Markdown table; the first is its head.
std::string markdown_table(const std::vector<std::vector<std::string>>& lines);

// A number with so many digits behind the point.
std::string fixed(double value, int digits);

// Puts `text` between the lines <!-- bench: NAME --> and <!-- end: NAME --> of the file, in place of what was
// there; at the end of the file if it has no such lines.
Expected<void> replace_section(const std::filesystem::path& file, const std::string& name,
                               const std::string& text);

}  // namespace bodyscan
