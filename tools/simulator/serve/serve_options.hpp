#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/pattern/sequence.hpp"
#include "tools/simulator/render_options.hpp"
#include "tools/simulator/serve/faults.hpp"

#include <filesystem>
#include <optional>
#include <vector>

namespace bodyscan::simulator {

// A world that is served.
struct ServeOptions {
  RenderOptions render;                    // its light: at 50 ms, ISO 200, f/8
  std::filesystem::path projector;         // the virtual projector's socket
  int port = 0;                            // of the camera, on 127.0.0.1; 0: any that is free
  double latency_ms = 30;                  // from a page flip to the first of its light on the wall
  double rise_ms = 20;                     // from then to all of its light
  std::optional<SequenceOptions> prepare;  // what is rendered beforehand, for 50 ms, ISO 200, f/8
  std::vector<Fault> faults;

  // An error of kind `usage` that names the command line's option.
  [[nodiscard]] Expected<void> check() const;
};

}  // namespace bodyscan::simulator
