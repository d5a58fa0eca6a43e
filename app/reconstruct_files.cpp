#include "app/reconstruct_files.hpp"

#include "app/calibration_fit.hpp"
#include "pipeline/base/read_file.hpp"
#include "pipeline/calibration/calibration_file.hpp"

#include <algorithm>
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

std::vector<std::filesystem::path> outputs_of(const ReconstructOptions& options) {
  std::vector<std::filesystem::path> outputs{options.model};
  for (const auto* path : {&options.report, &options.preview, &options.depth, &options.rows})
    if (*path) outputs.push_back(**path);
  return outputs;
}

}  // namespace

Expected<void> check_paths(const ReconstructOptions& options) {
  return check_distinct(outputs_of(options),
                        std::array{options.calibration, options.capture / "capture.json"});
}

Expected<ReconstructInputs> open_inputs(const ReconstructOptions& options) {
  Expected<CaptureFolder> capture = CaptureFolder::open(options.capture);
  if (!capture) return tl::unexpected(capture.error());
  if (Expected<void> kept = check_distinct(outputs_of(options), capture->files()); !kept)
    return tl::unexpected(kept.error());
  const Expected<std::vector<std::byte>> file = read_file(options.calibration, max_calibration_bytes);
  if (!file) return tl::unexpected(file.error());
  Expected<Calibration> calibration = parse_calibration(as_text(*file), options.calibration.string());
  if (!calibration) return tl::unexpected(calibration.error());
  if (Expected<void> fit = check_fit(*calibration, options.calibration,
                                     {options.capture, capture->size(), capture->manifest().projector});
      !fit)
    return tl::unexpected(fit.error());
  const auto& frames = capture->manifest().frames;
  const bool has_rows = std::any_of(frames.begin(), frames.end(), [](const ManifestFrame& frame) {
    return frame.pattern.kind == PatternKind::gray && frame.pattern.axis == Axis::row;
  });
  if (options.rows && !has_rows)
    return input_error(options.capture.string() + ": has no row patterns to draw");
  return ReconstructInputs{*calibration, name_and_checksum(options.calibration, *file), std::move(*capture)};
}

Expected<ReconstructOutputs> open_outputs(const ReconstructOptions& options, const ModelInfo& info) {
  Expected<VrmlWriter> model = VrmlWriter::create(options.model, VrmlGeometry::face_set, info);
  if (!model) return tl::unexpected(model.error());
  ReconstructOutputs outputs{std::move(*model), {}, {}, {}, {}};
  for (const auto& [output, path] :
       {std::pair(&outputs.report, &options.report), std::pair(&outputs.preview, &options.preview),
        std::pair(&outputs.depth, &options.depth), std::pair(&outputs.rows, &options.rows)}) {
    Expected<OptionalOutput> file = OptionalOutput::create(*path);
    if (!file) return tl::unexpected(file.error());
    *output = std::move(*file);
  }
  return outputs;
}

Expected<void> ReconstructOutputs::commit() {
  return model.finish()
      .and_then([&] { return report.commit(); })
      .and_then([&] { return preview.commit(); })
      .and_then([&] { return depth.commit(); })
      .and_then([&] { return rows.commit(); });
}

}  // namespace bodyscan
