#pragma once

#include "tools/evaluate/evaluation.hpp"
#include "tools/simulator/render_options.hpp"

namespace bodyscan {

// Renders the capture, reconstructs it with the executable and judges the model; in a temporary folder,
// whatever the options' `output`.
Expected<Evaluation> scan_simulated(simulator::RenderOptions options);

}  // namespace bodyscan
