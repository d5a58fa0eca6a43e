#include "tools/simulator/session_folder.hpp"

#include "pipeline/calibration/calibration_file.hpp"
#include "tools/simulator/blunders.hpp"
#include "tools/simulator/capture_folder.hpp"
#include "tools/simulator/frame_file.hpp"
#include "tools/simulator/option_range.hpp"
#include "tools/simulator/pose_camera.hpp"
#include "tools/simulator/session_json.hpp"

#include <utility>

namespace bodyscan::simulator {
namespace {

namespace fs = std::filesystem;

Expected<void> write_pair(const PoseCamera& camera, int number, const SessionTruth& truth,
                          const RenderOptions& options) {
  const Pattern white{.kind = PatternKind::white};
  return write_frame(options.output / printed_name(number, options.format), camera.take(white, 0), options)
      .and_then([&] {
        return write_frame(options.output / projected_name(number, options.format),
                           camera.take(truth.projected, 1), options);
      });
}

Expected<void> write_gray(const PoseCamera& camera, int number, const SessionTruth& truth,
                          const RenderOptions& options) {
  const fs::path folder = options.output / capture_name(number);
  const Expected<PatternSequence> sequence =
      make_sequence(truth.calibration.projector.size, {.rows = true, .columns = true, .inverses = true});
  if (!sequence) return tl::unexpected(sequence.error());
  return make_folder(folder).and_then([&] {
    return write_capture(
        folder, *sequence, [&](const Pattern& pattern, int index) { return camera.take(pattern, index); },
        options);
  });
}

}  // namespace

Expected<SessionTruth> plan_session(const SessionOptions& options) {
  if (Expected<void> checked = options.check(); !checked) return tl::unexpected(checked.error());
  Expected<Calibration> calibration = find_calibration(options.render.calibration, options.render.rig);
  if (!calibration) return tl::unexpected(calibration.error());
  Expected<ProjectedBoard> projected =
      options.method == SessionMethod::gray ? ProjectedBoard{} : plan_projected_board(options, *calibration);
  if (!projected) return tl::unexpected(projected.error());
  Expected<std::vector<SessionPose>> poses = plan_poses(options, *calibration, *projected);
  if (!poses) return tl::unexpected(poses.error());
  for (const PlantedBlunder& blunder : options.blunders)
    plant(blunder.kind, *calibration, (*poses)[static_cast<std::size_t>(blunder.pose)]);
  return SessionTruth{*calibration, *projected, std::move(*poses)};
}

Expected<SessionTruth> render_session(const SessionOptions& options) {
  const fs::path& folder = options.render.output;
  if (folder.empty()) return usage_error("--output: needs a folder");
  Expected<SessionTruth> truth = plan_session(options);
  if (!truth) return truth;
  Expected<void> written =
      make_folder(folder / "truth")
          .and_then([&] { return write_calibration(truth->calibration, folder / "calibration.yml"); })
          .and_then([&] {
            return write_json(folder / "truth" / "session.json", session_truth_json(*truth, options));
          });
  if (!written) return tl::unexpected(written.error());
  for (int i = 0; i < options.poses; ++i) {
    const SessionPose& pose = truth->poses[static_cast<std::size_t>(i)];
    const Expected<PoseCamera> camera = PoseCamera::make(truth->calibration, pose, i, options.render);
    if (!camera) return tl::unexpected(camera.error());
    written = pose.gray ? write_gray(*camera, i, *truth, options.render)
                        : write_pair(*camera, i, *truth, options.render);
    if (!written) return tl::unexpected(written.error());
  }
  written = write_json(folder / "session.json", session_json(*truth, options));
  if (!written) return tl::unexpected(written.error());
  return truth;
}

}  // namespace bodyscan::simulator
