#include "tools/bench/link_capture.hpp"

#include <fstream>

#include <nlohmann/json.hpp>

namespace bodyscan {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

void link_frames(const fs::path& capture, const fs::path& folder, bool rows_only) {
  std::ifstream stream(capture / "capture.json");
  json manifest = json::parse(stream);
  json kept = json::array();
  for (const json& frame : manifest.at("frames")) {
    if (rows_only && frame.value("axis", "") == "column") continue;
    const std::string file = frame.at("file");
    fs::create_symlink(fs::absolute(capture / file), folder / file);
    kept.push_back(frame);
  }
  manifest["frames"] = kept;
  std::ofstream(folder / "capture.json") << manifest.dump(1);
}

}  // namespace

Expected<void> link_capture(const fs::path& capture, const fs::path& folder, bool rows_only) {
  try {
    fs::create_directories(folder);
    link_frames(capture, folder, rows_only);
    for (const char* beside : {"calibration.yml", "truth"}) {
      if (fs::exists(capture / beside)) fs::create_symlink(fs::absolute(capture / beside), folder / beside);
    }
  } catch (const std::exception& error) {
    return input_error(capture.string() + ": " + error.what());
  }
  return {};
}

}  // namespace bodyscan
