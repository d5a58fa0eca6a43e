#include "app/named_calibration.hpp"

#include "pipeline/base/read_file.hpp"
#include "pipeline/calibration/calibration_file.hpp"

#include <array>
#include <cstdio>

#include <zlib.h>

namespace bodyscan {
namespace {

std::string name_and_checksum(const std::filesystem::path& path, const std::vector<std::byte>& file) {
  std::array<char, 16> checksum{};
  std::snprintf(checksum.data(), checksum.size(), "%08lx",
                crc32_z(0, reinterpret_cast<const Bytef*>(file.data()), file.size()));
  return path.filename().string() + " (CRC-32 " + checksum.data() + ")";
}

}  // namespace

Expected<NamedCalibration> read_named_calibration(const std::filesystem::path& path) {
  const Expected<std::vector<std::byte>> file = read_file(path, max_calibration_bytes);
  if (!file) return tl::unexpected(file.error());
  const Expected<Calibration> calibration = parse_calibration(as_text(*file), path.string());
  if (!calibration) return tl::unexpected(calibration.error());
  return NamedCalibration{*calibration, name_and_checksum(path, *file)};
}

}  // namespace bodyscan
