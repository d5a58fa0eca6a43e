#include "app/reconstruct_inputs.hpp"

#include "app/calibration_fit.hpp"

#include <algorithm>
#include <array>

namespace bodyscan {

Expected<ReconstructInputs> open_inputs(const ReconstructOptions& options) {
  const auto results = options.model.paths();
  if (Expected<void> distinct =
          check_distinct(results, std::array{options.calibration, options.capture / "capture.json"});
      !distinct)
    return tl::unexpected(distinct.error());
  Expected<CaptureFolder> capture = CaptureFolder::open(options.capture);
  if (!capture) return tl::unexpected(capture.error());
  if (Expected<void> kept = check_distinct(results, capture->files()); !kept)
    return tl::unexpected(kept.error());
  Expected<NamedCalibration> calibration = read_named_calibration(options.calibration);
  if (!calibration) return tl::unexpected(calibration.error());
  if (Expected<void> fit = check_fit(calibration->calibration, options.calibration,
                                     {options.capture, capture->size(), capture->manifest().projector});
      !fit)
    return tl::unexpected(fit.error());
  const auto& frames = capture->manifest().frames;
  const bool has_rows = std::any_of(frames.begin(), frames.end(), [](const ManifestFrame& frame) {
    return frame.pattern.kind == PatternKind::gray && frame.pattern.axis == Axis::row;
  });
  if (options.model.rows && !has_rows)
    return input_error(options.capture.string() + ": has no row patterns to draw");
  return ReconstructInputs{std::move(*calibration), std::move(*capture)};
}

}  // namespace bodyscan
