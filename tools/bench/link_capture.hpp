#pragma once

#include "pipeline/base/error.hpp"

#include <filesystem>

namespace bodyscan {

// Makes `folder` a capture of links to the pictures of `capture`, without the column patterns' where
// `rows_only`; a calibration and a truth beside them are linked too. Messages start with the capture's path.
Expected<void> link_capture(const std::filesystem::path& capture, const std::filesystem::path& folder,
                            bool rows_only);

}  // namespace bodyscan
