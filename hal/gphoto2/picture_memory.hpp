#pragma once

#include "hal/unique_fd.hpp"
#include "pipeline/base/error.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace bodyscan::gphoto2 {

// A memory file that holds these bytes and can be changed by nobody any more.
Expected<UniqueFd> seal_picture(std::span<const std::byte> bytes);

// The bytes of a memory file from someone who is not trusted; nothing where it is not sealed as above or does
// not have that size. The size is the caller's to limit.
std::optional<std::vector<std::byte>> read_sealed_picture(int descriptor, std::size_t bytes);

}  // namespace bodyscan::gphoto2
