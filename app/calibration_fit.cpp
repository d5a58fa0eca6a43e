#include "app/calibration_fit.hpp"

#include "pipeline/base/size_text.hpp"

#include <string>

namespace bodyscan {

Expected<void> check_fit(const Calibration& calibration, const std::filesystem::path& file,
                         const PicturesOf& pictures) {
  const auto check = [&](const char* device, Size calibrated, Size size) -> Expected<void> {
    if (calibrated == size) return {};
    return input_error(file.string() + ": " + device + "_size: " + text_of(calibrated) + ", but the " +
                       device + " of " + pictures.folder.string() + " has " + text_of(size));
  };
  return check("projector", calibration.projector.size, pictures.projector).and_then([&] {
    return check("camera", calibration.camera.size, pictures.camera);
  });
}

}  // namespace bodyscan
