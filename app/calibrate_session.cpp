#include "app/calibrate_session.hpp"

#include "app/calibrate_files.hpp"
#include "app/interrupt.hpp"
#include "app/session_poses.hpp"
#include "app/stage_clock.hpp"
#include "app/version.hpp"

namespace bodyscan {

Expected<CalibrateOutcome> calibrate_session(const CalibrateOptions& options, Progress& progress) {
  StageClock clock;
  const Expected<CalibrateInputs> inputs = open_inputs(options);
  if (!inputs) return tl::unexpected(inputs.error());
  Expected<CalibrateOutputs> outputs = CalibrateOutputs::open(options);
  if (!outputs) return tl::unexpected(outputs.error());
  clock.end_stage("open");

  const auto in_session = [&](const Error& error) { return error.within(options.session.string()); };
  auto poses = look_at_poses(inputs->session, progress).map_error(in_session);
  if (!poses) return tl::unexpected(poses.error());
  clock.end_stage("find_boards");

  progress.show("calibrating");
  const SessionManifest& manifest = inputs->session.manifest();
  auto result = calibrate({manifest.board, inputs->session.size(), manifest.projector,
                           manifest.projected_board, std::move(*poses), inputs->kept})
                    .map_error(in_session);
  if (!result) return tl::unexpected(result.error());
  clock.end_stage("calibrate");

  CalibrateOutcome outcome{std::move(*result), {std::string(software_version()), clock.stages_ms()}};
  const Expected<void> written =
      check_interrupt().and_then([&] { return outputs->write(outcome, *inputs); }).and_then([&] {
        return outputs->commit();
      });
  if (!written) return tl::unexpected(written.error());
  return outcome;
}

}  // namespace bodyscan
