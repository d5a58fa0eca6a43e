#pragma once

#include "pipeline/base/error.hpp"
#include "tools/simulator/render_options.hpp"

#include <string>
#include <vector>

namespace bodyscan {

// A simulated scene that the whole pipeline is judged on.
struct BenchScene {
  std::string name;
  std::string title;                 // for tables
  simulator::RenderOptions options;  // `output` is left to the caller
};

// The scenes of the accuracy table; `scale` is the camera's over the Nikon D5000's 4288 x 2848.
std::vector<BenchScene> accuracy_scenes(double scale);

// One of the above, or a scene that only time is measured on: "speed" (a torso that fills half of the
// picture, rows and columns) and "growth" (the same, rows only, rendered coarsely and without the true mesh).
Expected<BenchScene> bench_scene(const std::string& name, double scale);

}  // namespace bodyscan
