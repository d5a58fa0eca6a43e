#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/decode/axis_decoder.hpp"
#include "pipeline/decode/correspondence.hpp"
#include "pipeline/decode/decode_options.hpp"
#include "pipeline/decode/illumination.hpp"
#include "pipeline/decode/middle_light.hpp"
#include "pipeline/image/frame.hpp"
#include "pipeline/pattern/sequence.hpp"

#include <optional>
#include <vector>

namespace bodyscan {

// Takes a sequence frame by frame, as the camera delivers it, and keeps a fixed number of bytes a
// pixel. Decoder: white, black, then for each axis its phase steps, if it has any, and its bits, coarsest
// first
// -> finish. Frames must come in the sequence's
// order; anything else is an error that names the frame expected.
class Decoder {
 public:
  // The sequence must be one that make_sequence makes: with inverses, without, or with a phase code.
  static Expected<Decoder> create(PatternSequence sequence, const DecodeOptions& options = {});

  Expected<void> consume(const Frame& frame);

  // After the last frame; leaves the decoder empty.
  Expected<Correspondence> finish();

 private:
  // An axis is decoded once its last frame has come: at once where other frames follow, else by `finish`.
  struct OneAxis {
    std::optional<AxisDecoder> decoder;
    std::optional<AxisCorrespondence> found;
  };

  Decoder(PatternSequence sequence, const DecodeOptions& options);

  Expected<void> consume_white_black(const Frame& frame);
  Expected<void> consume_stripes(const Frame& frame);
  Expected<void> consume_bit(AxisDecoder& axis, const Frame& frame);
  Expected<void> settle_response(const Luma& pattern, const Luma& inverse);
  Expected<void> use_response(const ToneResponse& response);
  void finish_axis(OneAxis& axis);
  OneAxis& of(Axis axis) { return axis == Axis::row ? rows_ : columns_; }

  PatternSequence sequence_;
  DecodeOptions options_;
  bool inverses_ = false;
  std::optional<PhaseCode> phase_;
  std::size_t next_ = 0;
  Size camera_;
  std::size_t depth_ = 0;  // index of Luma
  ToneResponse response_;
  bool response_settled_ = false;
  std::vector<std::uint16_t> linear_;
  Luma white_;  // white and black stay until the response is settled
  Luma black_;
  Luma held_;           // a pattern until its inverse comes
  MiddleLight middle_;  // for sequences without inverses
  Illumination light_;
  OneAxis rows_;
  OneAxis columns_;
};

}  // namespace bodyscan
