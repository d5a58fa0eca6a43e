#pragma once

#include "running_scan.hpp"
#include "tests/integration/simulator/served_world.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace bodyscan {

// The scene of all these tests, as options of the simulator: quick, and with moles that tell motion.
std::vector<std::string> scene_options();

// A served world, and the rig file of who scans it.
class Station {
 public:
  // No fault where it is empty.
  explicit Station(const std::string& fault = {});

  [[nodiscard]] ServedWorld& world() { return world_; }
  [[nodiscard]] std::filesystem::path rig() const { return world_.folder() / "rig.toml"; }
  [[nodiscard]] std::filesystem::path model() const { return results() / "model.wrl"; }
  // What the scan before left behind is removed.
  [[nodiscard]] RunningScan start();
  ScanEnd scan(std::chrono::milliseconds limit = std::chrono::seconds(60)) { return start().end(limit); }

  [[nodiscard]] std::vector<std::string> files() const;  // names in the folder of results, sorted
  [[nodiscard]] nlohmann::json report() const;           // its part "scan"

 private:
  [[nodiscard]] std::filesystem::path results() const { return world_.folder() / "results"; }

  ServedWorld world_;
};

}  // namespace bodyscan
