#pragma once

#include "pipeline/drawing/printable_board.hpp"

#include <string>

namespace bodyscan {

// Files that print at true scale.

std::string to_svg(const BoardPage& page);

// PDF 1.4 (ISO 32000-1), one page. Asks the viewer not to fit it to the paper.
std::string to_pdf(const BoardPage& page);

}  // namespace bodyscan
