#pragma once

namespace bodyscan {

// How a photograph's values v (0 to 1) follow from the light: sRGB (IEC 61966-2-1), v = light, or
// v = light^(1/gamma).
struct ToneResponse {
  enum class Kind { srgb, linear, gamma };

  Kind kind = Kind::srgb;
  double gamma = 1;  // read where kind is gamma

  friend bool operator==(const ToneResponse&, const ToneResponse&) = default;
};

}  // namespace bodyscan
