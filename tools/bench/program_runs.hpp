#pragma once

#include "pipeline/base/error.hpp"
#include "tools/bench/child_process.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace bodyscan {

// Everything heavy runs in a child of its own: a child's peak memory is never below its parent's at the
// start.

// Fails where the program does not end with status 0.
Expected<ProcessUsage> run_successfully(const std::vector<std::string>& arguments,
                                        const std::filesystem::path& output = {});

struct JsonRun {
  nlohmann::ordered_json result;  // the program's standard output
  ProcessUsage usage;
};
Expected<JsonRun> run_for_json(const std::vector<std::string>& arguments,
                               const std::filesystem::path& scratch_file);

// This program's own subcommand.
std::vector<std::string> own_command(const std::vector<std::string>& arguments);

// `bodyscan reconstruct --json` on a simulated capture with its own calibration.
Expected<JsonRun> reconstruct_capture(const std::filesystem::path& capture,
                                      const std::filesystem::path& model);

// `bodyscan-evaluate --json`.
Expected<nlohmann::ordered_json> evaluate_model(const std::filesystem::path& model,
                                                const std::filesystem::path& capture);

// Renders the bench scene `name` into an empty folder.
Expected<void> render_scene(const std::string& name, double scale, const std::filesystem::path& folder);

// Waits until everything written so far is on the disk, so that one run does not pay for another's output.
void settle_disk();

}  // namespace bodyscan
