#include "tools/simulator/render_options.hpp"

#include <cmath>

namespace bodyscan::simulator {
namespace {

struct Range {
  const char* option;
  double value;
  double smallest;
  double largest;
};

tl::unexpected<Error> usage(std::string message) {
  return tl::unexpected(Error{ErrorKind::usage, std::move(message)});
}

std::string number(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

}  // namespace

Expected<void> RenderOptions::check() const {
  for (const Range& range :
       {Range{"--detail", detail, 0.05, 20}, Range{"--scale-subject", subject_scale, 1e-6, 1e6},
        Range{"--light", light, 0, 100}, Range{"--contrast", contrast, 1, 1e9},
        Range{"--ambient", ambient, 0, 1}, Range{"--reflection", reflection, 0, 1},
        Range{"--defocus", defocus, 0, 50}, Range{"--subsurface", subsurface, -1, 1},
        Range{"--subsurface-blur", subsurface_blur, 0, 50}, Range{"--rays", static_cast<double>(rays), 1, 8},
        Range{"--full-well", full_well, 0, 1e9}, Range{"--read-noise", read_noise, 0, 1e6},
        Range{"--jpeg-quality", static_cast<double>(jpeg_quality), 1, 100}}) {
    if (!(range.value >= range.smallest && range.value <= range.largest))
      return usage(std::string(range.option) + ": must lie in " + number(range.smallest) + " to " +
                   number(range.largest));
  }
  if (!pose_rotation.allFinite() || !pose_translation.allFinite()) return usage("--pose: not finite");
  if (!motion.allFinite()) return usage("--motion: not finite");
  if (material != "own" && material != "matt" && material != "skin")
    return usage("--material: no material \"" + material + "\" (there are: own, matt, skin)");
  if (!sequence.rows && !sequence.columns) return usage("--axes: a capture needs rows, columns or both");
  return {};
}

}  // namespace bodyscan::simulator
