#include "tools/bench/program_runs.hpp"

#include <fstream>

#include <unistd.h>

namespace bodyscan {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

Expected<ProcessUsage> run_successfully(const std::vector<std::string>& arguments, const fs::path& output) {
  Expected<ProcessUsage> usage = run_program(arguments, output);
  if (usage && usage->exit_status != 0) {
    return input_error(arguments[0] + ": ended with status " + std::to_string(usage->exit_status));
  }
  return usage;
}

Expected<JsonRun> run_for_json(const std::vector<std::string>& arguments, const fs::path& scratch_file) {
  const Expected<ProcessUsage> usage = run_successfully(arguments, scratch_file);
  if (!usage) return tl::unexpected(usage.error());
  std::ifstream stream(scratch_file);
  json result = json::parse(stream, nullptr, /*allow_exceptions=*/false);
  stream.close();
  std::error_code ignored;
  fs::remove(scratch_file, ignored);
  if (result.is_discarded()) return input_error(arguments[0] + ": did not print a JSON object");
  return JsonRun{std::move(result), *usage};
}

std::vector<std::string> own_command(const std::vector<std::string>& arguments) {
  std::vector<std::string> command{"/proc/self/exe"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return command;
}

Expected<JsonRun> reconstruct_capture(const fs::path& capture, const fs::path& model) {
  return run_for_json({BODYSCAN_EXECUTABLE, "reconstruct", capture.string(), "--calibration",
                       (capture / "calibration.yml").string(), "--output", model.string(), "--json"},
                      model.string() + ".json");
}

Expected<json> evaluate_model(const fs::path& model, const fs::path& capture) {
  Expected<JsonRun> run =
      run_for_json({BODYSCAN_EVALUATE, model.string(), capture.string(), "--json"}, model.string() + ".json");
  if (!run) return tl::unexpected(run.error());
  return std::move(run->result);
}

Expected<void> render_scene(const std::string& name, double scale, const fs::path& folder) {
  const Expected<ProcessUsage> usage =
      run_successfully(own_command({"render", name, std::to_string(scale), folder.string()}));
  if (!usage) return tl::unexpected(usage.error());
  return {};
}

void settle_disk() {
  sync();
}

}  // namespace bodyscan
