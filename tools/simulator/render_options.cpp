#include "tools/simulator/render_options.hpp"

#include "tools/simulator/option_range.hpp"

#include <cmath>

namespace bodyscan::simulator {

Expected<void> RenderOptions::check() const {
  const Expected<void> in_range =
      check_ranges({{"--detail", detail, 0.05, 20},
                    {"--scale-subject", subject_scale, 1e-6, 1e6},
                    {"--light", light, 0, 100},
                    {"--contrast", contrast, 1, 1e9},
                    {"--ambient", ambient, 0, 1},
                    {"--reflection", reflection, 0, 1},
                    {"--defocus", defocus, 0, 50},
                    {"--subsurface", subsurface, -1, 1},
                    {"--subsurface-blur", subsurface_blur, 0, 50},
                    {"--uneven-light", uneven_light, 0, 1},
                    {"--rays", static_cast<double>(rays), 1, 8},
                    {"--lens-blur", lens_blur, 0, 50},
                    {"--full-well", full_well, 0, 1e9},
                    {"--read-noise", read_noise, 0, 1e6},
                    {"--jpeg-quality", static_cast<double>(jpeg_quality), 1, 100}});
  if (!in_range) return in_range;
  if (!pose_rotation.allFinite() || !pose_translation.allFinite()) return usage_error("--pose: not finite");
  if (!motion.allFinite()) return usage_error("--motion: not finite");
  if (material != "own" && material != "matt" && material != "skin")
    return usage_error("--material: no material \"" + material + "\" (there are: own, matt, skin)");
  if (!sequence.rows && !sequence.columns)
    return usage_error("--axes: a capture needs rows, columns or both");
  return {};
}

}  // namespace bodyscan::simulator
