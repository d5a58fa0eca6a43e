#include "pipeline/decode/decode_options.hpp"

#include "pipeline/decode/stripe_planes.hpp"

namespace bodyscan {

Expected<void> DecodeOptions::check() const {
  const auto refuse = [](const char* what) { return tl::unexpected(Error{ErrorKind::usage, what}); };
  if (!(min_contrast >= 1 && min_contrast <= 255))
    return refuse("min_contrast must lie in 1 to 255 grey levels");
  if (!(min_direct_share >= 0 && min_direct_share < 1)) return refuse("min_direct_share must lie in 0 to 1");
  if (!(min_signal_to_noise >= 0)) return refuse("min_signal_to_noise must not be negative");
  if (max_dropped_bits < 0 || max_dropped_bits >= StripePlanes::fine_bits)
    return refuse("max_dropped_bits must be 0, 1 or 2");
  if (response && response->kind == ToneResponse::Kind::gamma &&
      !(response->gamma >= 0.1 && response->gamma <= 10))
    return refuse("gamma must lie in 0.1 to 10");
  return brightness_edges.check().and_then([this] { return fit.check(); });
}

}  // namespace bodyscan
