#include "pipeline/base/median.hpp"
#include "pipeline/calibration/calibration_file.hpp"
#include "tools/bench/markdown.hpp"
#include "tools/bench/parts.hpp"
#include "tools/bench/program_runs.hpp"
#include "tools/simulator/session_folder.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>

namespace bodyscan {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

constexpr int poses = 7;

struct Method {
  const char* title;
  const char* name;
  simulator::SessionMethod method;
};
constexpr std::array<Method, 2> methods{
    Method{"printed and projected board, 14 pictures", "pairs", simulator::SessionMethod::projected},
    Method{"Gray code, 308 pictures", "gray", simulator::SessionMethod::gray}};

simulator::SessionOptions session_options(const Method& method, const fs::path& folder) {
  simulator::SessionOptions options;
  options.render.calibration = "builtin:diagonal";
  options.render.rig.name = "diagonal";
  options.render.rig.scale = 1;
  options.render.output = folder;
  options.method = method.method;
  options.poses = poses;
  return options;
}

Expected<void> render(const Method& method, const fs::path& folder) {
  fs::remove_all(folder);
  std::fprintf(stderr, "calibration: rendering %s\n", method.title);
  const auto truth = simulator::render_session(session_options(method, folder));
  if (!truth) return tl::unexpected(truth.error());
  return {};
}

std::vector<std::string> calibrate_command(const fs::path& session, const fs::path& output,
                                           const std::vector<std::string>& more = {}) {
  std::vector<std::string> command{BODYSCAN_EXECUTABLE, "calibrate",     session.string(),
                                   "--output",          output.string(), "--json"};
  command.insert(command.end(), more.begin(), more.end());
  return command;
}

struct Timed {
  json report;
  double seconds = 0;
};

Expected<Timed> calibrate_repeatedly(const BenchOptions& options, const std::vector<std::string>& command) {
  Timed timed;
  std::vector<double> seconds;
  for (int repeat = 0; repeat < options.repeats; ++repeat) {
    Expected<JsonRun> run = run_for_json(command, options.work / "calibration.json");
    if (!run) return tl::unexpected(run.error());
    timed.report = std::move(run->result);
    seconds.push_back(run->usage.wall_s);
  }
  timed.seconds = median(seconds);
  return timed;
}

std::string percent_off(double value, double truth) {
  return fixed(100 * (value / truth - 1), 4);
}

Expected<std::string> sphere_spacing(const BenchOptions& options, const fs::path& calibration) {
  const fs::path capture = options.work / "calibration_spheres";
  const fs::path model = options.work / "calibration_spheres.wrl";
  if (!fs::exists(capture)) {
    std::fprintf(stderr, "calibration: rendering plate and spheres\n");
    if (auto rendered = render_scene("both", 1.0, capture); !rendered)
      return tl::unexpected(rendered.error());
  }
  const auto run = run_successfully({BODYSCAN_EXECUTABLE, "reconstruct", capture.string(), "--calibration",
                                     calibration.string(), "--output", model.string()});
  if (!run) return tl::unexpected(run.error());
  const auto judged = evaluate_model(model, capture);
  if (!judged) return tl::unexpected(judged.error());
  return fixed(judged->at("sphere_spacing_error_mm").get<double>(), 4);
}

Expected<std::vector<std::string>> accuracy_line(const BenchOptions& options, const Method& method,
                                                 const fs::path& session, const fs::path& output) {
  const auto timed = calibrate_repeatedly(options, calibrate_command(session, output));
  if (!timed) return tl::unexpected(timed.error());
  const auto found = read_calibration(output);
  if (!found) return tl::unexpected(found.error());
  const auto truth = read_calibration(session / "calibration.yml");
  if (!truth) return tl::unexpected(truth.error());
  const auto spacing = sphere_spacing(options, output);
  if (!spacing) return tl::unexpected(spacing.error());
  const auto figure = [&](const char* key) { return timed->report.at(key).get<double>(); };
  return std::vector<std::string>{
      method.title,
      percent_off(found->camera.fx, truth->camera.fx),
      percent_off(found->projector.fx, truth->projector.fx),
      percent_off(found->projector_from_camera.translation.norm(),
                  truth->projector_from_camera.translation.norm()),
      fixed(figure("camera_rms_px"), 3),
      fixed(figure("projector_rms_px"), 3),
      fixed(figure("leave_one_out_camera_px"), 3) + ", " + fixed(figure("leave_one_out_projector_px"), 3),
      fixed(figure("square_error_percent"), 4) + ", " + fixed(figure("square_spread_percent"), 3),
      *spacing,
      fixed(timed->seconds, 2)};
}

// The session with its first pose alone.
Expected<fs::path> one_pose(const fs::path& session) {
  std::ifstream whole(session / "session.json");
  json manifest = json::parse(whole);
  json& all = manifest.at("poses");
  all = json::array({all.at(0)});
  const fs::path one = session.string() + "_one";
  fs::remove_all(one);
  fs::create_directories(one);
  for (const auto& [key, file] : all.at(0).items())
    fs::create_symlink(fs::absolute(session / file.get<std::string>()), one / file.get<std::string>());
  std::ofstream(one / "session.json") << manifest;
  return one;
}

std::string peer_time(const fs::path& picture) {
  const auto run = run_program({BODYSCAN_PEER_CHESSBOARD, picture.string(), "9", "7", "60"});
  if (!run) return "not started";
  if (run->exit_status == 0) return fixed(run->wall_s, 2);
  return run->exit_status == 1 ? fixed(run->wall_s, 2) + ", not found" : "over 60, stopped";
}

Expected<std::string> time_table(const BenchOptions& options, const fs::path& session,
                                 const fs::path& calibration) {
  const auto one = one_pose(session);
  if (!one) return tl::unexpected(one.error());
  const auto extrinsics = calibrate_repeatedly(
      options,
      calibrate_command(*one, options.work / "extrinsics.yml", {"--keep-intrinsics", calibration.string()}));
  if (!extrinsics) return tl::unexpected(extrinsics.error());
  return markdown_table(
      {{"12-megapixel pictures", "time s"},
       {"bodyscan: both boards of one pair found, and the projector's pose from it (extrinsics alone)",
        fixed(extrinsics->seconds, 2)},
       {"cv::findChessboardCorners at full size, the printed board of that pair",
        peer_time(*one / "pose_0_printed.jpg")},
       {"cv::findChessboardCorners at full size, the projected board on top of it",
        peer_time(*one / "pose_0_projected.jpg")}});
}

}  // namespace

Expected<std::string> calibration_part(const BenchOptions& options) {
  std::vector<std::vector<std::string>> lines{
      {"method", "camera focal length off by %", "projector's", "baseline's", "camera RMS px",
       "projector RMS px", "a pose left out, px", "squares: error, spread %", "sphere spacing mm", "time s"}};
  fs::path pairs;
  fs::path calibration;
  for (const Method& method : methods) {
    const fs::path session = options.work / (std::string("session_") + method.name);
    const fs::path output = options.work / (std::string("calibration_") + method.name + ".yml");
    if (auto rendered = render(method, session); !rendered) return tl::unexpected(rendered.error());
    auto line = accuracy_line(options, method, session, output);
    if (!line) return tl::unexpected(line.error());
    lines.push_back(*line);
    if (method.method == simulator::SessionMethod::projected) {
      pairs = session;
      calibration = output;
    } else {
      fs::remove_all(session);
    }
  }
  const auto times = time_table(options, pairs, calibration);
  if (!times) return tl::unexpected(times.error());
  return "## Calibration\n\nSeven poses of a 9 x 7 board of 25 mm squares, simulated at 4288 x 2848 with a "
         "1024 "
         "x 768 projector; found with no knowledge of the rig. Sphere spacing: error in a scan of plate and "
         "spheres made with the calibration found.\n\n" +
         markdown_table(lines) + "\n" + *times;
}

}  // namespace bodyscan
