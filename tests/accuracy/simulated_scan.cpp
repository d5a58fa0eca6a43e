#include "tests/accuracy/simulated_scan.hpp"

#include "tests/support/temporary_folder.hpp"
#include "tools/bench/child_process.hpp"
#include "tools/simulator/capture_folder.hpp"

#include <filesystem>
#include <string>

namespace bodyscan {
namespace {

constexpr double footprint_mm = 0.66;  // of a pixel at 1.05 m: finer true meshes only take time

}  // namespace

Expected<Evaluation> scan_simulated(simulator::RenderOptions options) {
  const TemporaryFolder folder;
  const std::filesystem::path capture = folder.path() / "capture";
  options.output = capture;
  options.detail = footprint_mm;
  if (const auto rendered = simulator::render_capture(options); !rendered)
    return tl::unexpected(rendered.error());

  const std::filesystem::path model = folder.path() / "model.wrl";
  const Expected<ProcessUsage> run =
      run_program({BODYSCAN_EXECUTABLE, "reconstruct", capture.string(), "--calibration",
                   (capture / "calibration.yml").string(), "--output", model.string()});
  if (!run) return tl::unexpected(run.error());
  if (run->exit_status != 0)
    return input_error("reconstruct: ended with status " + std::to_string(run->exit_status));
  return evaluate_files(model, capture);
}

}  // namespace bodyscan
