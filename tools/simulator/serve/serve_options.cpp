#include "tools/simulator/serve/serve_options.hpp"

#include "tools/simulator/option_range.hpp"

namespace bodyscan::simulator {

Expected<void> ServeOptions::check() const {
  constexpr double longest_ms = 10'000;
  return render.check()
      .and_then([&] { return check_projector_size(render.rig.projector, "--projector-size"); })
      .and_then([&] {
        return check_ranges({{"--port", static_cast<double>(port), 0, 65535},
                             {"--latency-ms", latency_ms, 0, longest_ms},
                             {"--rise-ms", rise_ms, 0, longest_ms}});
      });
}

}  // namespace bodyscan::simulator
