#pragma once

#include "pipeline/decode/correspondence.hpp"
#include "pipeline/decode/decode_options.hpp"
#include "pipeline/image/frame.hpp"
#include "pipeline/pattern/sequence.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace bodyscan {

// What one camera pixel sees.
struct Sight {
  double row = 0;  // projector px
  double column = 0;
  double albedo = 0.7;    // linear light, share of the camera's full scale, that white returns
  double blur_px = 0.45;  // standard deviation of the stripes' Gaussian edge, projector px
  double wide_share = 0;  // of the light that is spread by a second, wider Gaussian (subsurface scattering)
  double wide_px = 4;     // its standard deviation
  bool shadow = false;    // no direct light
  double scattered = 0;   // light from elsewhere in the scene, share of the albedo, spread over scattered_px
  double scattered_row = 0;  // around this projector row
  double scattered_px = 60;
};

// The same rule gives the truth a decoder is judged by.
using Scene = std::function<Sight(int x, int y)>;

struct CaptureOptions {
  Size camera{256, 192};
  SequenceOptions sequence = {};
  Size projector{1024, 768};
  ToneResponse response = {};
  int bits = 8;            // 8 or 16
  double ambient = 0.02;   // linear light
  double read_noise = 0;   // standard deviation, linear light
  double shot_noise = 0;   // variance a unit of linear light
  double camera_blur = 0;  // standard deviation of the camera's point spread, camera px
  unsigned seed = 1;
};

// A plane seen at an angle: the projector's rows run at `turn_degrees` to the camera's, `px_per_row` camera
// pixels a projector row, and meet the picture's middle at (row, column).
Scene plane_scene(const CaptureOptions& options, double turn_degrees = 0, double px_per_row = 2.7);

// The frames in the sequence's order, each pattern box stripes spread by the pixel's blur, rounded to the
// encoded grey levels.
std::vector<Frame> capture(const Scene& scene, const CaptureOptions& options);

PatternSequence sequence_of(const CaptureOptions& options);

// Decodes the scene's capture; throws std::runtime_error with the decoder's message on an error. The response
// is the capture's.
Correspondence decode(const Scene& scene, const CaptureOptions& options, DecodeOptions decoding = {});
Correspondence decode(const std::vector<Frame>& frames, const PatternSequence& sequence,
                      const DecodeOptions& decoding);

struct Comparison {
  double rms = 0;
  double worst = 0;
  double mean = 0;
  double mean_sigma = 0;  // root mean square of the predicted standard deviations
  int pixels = 0;         // compared
  int undecided = 0;
};

// Measured less true coordinate over the pixels for which `where` holds.
Comparison compare(const AxisCorrespondence& measured, Axis axis, const Scene& scene,
                   const std::function<bool(int, int)>& where);

// All but a margin of the picture.
std::function<bool(int, int)> interior(Size camera, int margin = 10);

}  // namespace bodyscan
