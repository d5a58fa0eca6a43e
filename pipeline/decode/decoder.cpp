#include "pipeline/decode/decoder.hpp"

#include "pipeline/base/parallel.hpp"
#include "pipeline/decode/response.hpp"

#include <atomic>
#include <cmath>
#include <utility>

namespace bodyscan {
namespace {

template <class Pixel>
void copy_pixels(const Image<Pixel>& from, Luma& to) {
  auto* reuse = std::get_if<Image<Pixel>>(&to);
  if (reuse == nullptr || reuse->size() != from.size()) {
    to = from.clone();
    return;
  }
  std::copy_n(from.data(), from.size().area(), reuse->data());
}

void copy_luma(const Luma& from, Luma& to) {
  std::visit([&](const auto& image) { copy_pixels(image, to); }, from);
}

std::size_t count_decoded(const Correspondence& found) {
  std::atomic<std::size_t> decoded = 0;
  parallel_for(0, found.camera.height, 64, [&](int begin, int end) {
    std::size_t here = 0;
    for (int y = begin; y < end; ++y) {
      for (int x = 0; x < found.camera.width; ++x)
        here += (!found.rows || !std::isnan(found.rows->coordinate(x, y))) &&
                (!found.columns || !std::isnan(found.columns->coordinate(x, y)));
    }
    decoded += here;
  });
  return decoded;
}

// The options under which make_sequence would make these patterns, if there are any.
SequenceOptions shape_of(const std::vector<Pattern>& patterns) {
  SequenceOptions shape{.rows = false, .columns = false, .inverses = false, .phase = {}};
  int finest = PhaseCode::max_finest_bit + 1;
  for (const Pattern& pattern : patterns) {
    if (pattern.kind == PatternKind::white || pattern.kind == PatternKind::black) continue;
    (pattern.axis == Axis::row ? shape.rows : shape.columns) = true;
    shape.inverses |= pattern.inverted;
    if (pattern.kind == PatternKind::phase)
      shape.phase = PhaseCode{.period_px = pattern.period_px, .steps = pattern.steps, .finest_bit = 0};
    else
      finest = std::min(finest, pattern.bit);
  }
  if (shape.phase) shape.phase->finest_bit = finest;
  return shape;
}

}  // namespace

Decoder::Decoder(PatternSequence sequence, const DecodeOptions& options)
    : sequence_(std::move(sequence)), options_(options) {}

Expected<Decoder> Decoder::create(PatternSequence sequence, const DecodeOptions& options) {
  if (auto checked = options.check(); !checked) return tl::unexpected(checked.error());
  const SequenceOptions shape = shape_of(sequence.patterns);
  const auto canonical = make_sequence(sequence.projector, shape);
  if (!canonical) return tl::unexpected(canonical.error());
  if (canonical->patterns != sequence.patterns)
    return tl::unexpected(
        Error{ErrorKind::usage,
              "the sequence must be white, black, then rows and columns: phase steps if any, then bit by "
              "bit, coarsest first, each with its inverse or all without"});
  Decoder decoder(std::move(sequence), options);
  decoder.inverses_ = shape.inverses;
  decoder.phase_ = shape.phase;
  return decoder;
}

Expected<void> Decoder::consume(const Frame& frame) {
  if (next_ == sequence_.patterns.size()) return input_error("a frame came after the sequence's last one");
  const Pattern& expected = sequence_.patterns[next_];
  if (frame.pattern != expected)
    return input_error("expected the frame of pattern " + describe(expected) + ", got " +
                       describe(frame.pattern));
  if (next_ > 0 && (size_of(frame.luma) != camera_ || frame.luma.index() != depth_))
    return input_error("the frame of pattern " + describe(expected) +
                       " differs from the first in size or depth");
  camera_ = size_of(frame.luma);
  depth_ = frame.luma.index();
  ++next_;
  const bool whole = frame.pattern.kind == PatternKind::white || frame.pattern.kind == PatternKind::black;
  return whole ? consume_white_black(frame) : consume_stripes(frame);
}

Expected<void> Decoder::consume_white_black(const Frame& frame) {
  if (frame.pattern.kind == PatternKind::white) {
    copy_luma(frame.luma, white_);
    return {};
  }
  copy_luma(frame.luma, black_);
  response_settled_ = options_.response.has_value() || !inverses_;
  return use_response(options_.response.value_or(ToneResponse{}));
}

Expected<void> Decoder::use_response(const ToneResponse& response) {
  response_ = response;
  linear_ = linear_table(response, std::holds_alternative<GrayImage8>(white_) ? 8 : 16);
  auto light = measure_illumination(white_, black_, options_.min_contrast, linear_);
  if (!light) return tl::unexpected(light.error());
  light_ = std::move(*light);
  if (!inverses_) middle_ = MiddleLight(white_, black_, linear_);
  if (response_settled_) {
    white_ = {};
    black_ = {};
  }
  return {};
}

// A bit too coarse to tell may still have an edge on the subject, so its differences are kept, rescaled.
Expected<void> Decoder::settle_response(const Luma& pattern, const Luma& inverse) {
  if (response_settled_) return {};
  const ResponseTest test = test_response(white_, black_, pattern, inverse);
  if (test.samples == 0) return {};
  response_settled_ = true;
  const Image<std::uint16_t> before = std::move(light_.contrast);
  auto used = use_response(test.instead.value_or(response_));
  if (!used) return used;
  for (OneAxis* axis : {&rows_, &columns_})
    if (test.instead && axis->decoder) axis->decoder->rescale(before, light_.contrast);
  return {};
}

Expected<void> Decoder::consume_stripes(const Frame& frame) {
  const Pattern& pattern = frame.pattern;
  OneAxis& axis = of(pattern.axis);
  if (!axis.decoder) {
    const Size projector = sequence_.projector;
    axis.decoder.emplace(camera_, count_along(pattern.axis, projector), phase_);
  }
  if (pattern.kind == PatternKind::phase) {
    axis.decoder->add_step(pattern.step, frame.luma, linear_, light_, middle_);
    return {};
  }
  if (auto taken = consume_bit(*axis.decoder, frame); !taken) return taken;
  if (axis.decoder->complete() && response_settled_ && next_ < sequence_.patterns.size()) finish_axis(axis);
  return {};
}

Expected<void> Decoder::consume_bit(AxisDecoder& axis, const Frame& frame) {
  const Pattern& pattern = frame.pattern;
  if (!inverses_) {
    axis.add_against(pattern.bit, frame.luma, middle_, linear_, light_);
  } else if (pattern.inverted) {
    if (auto settled = settle_response(held_, frame.luma); !settled) return settled;
    axis.add(pattern.bit, held_, frame.luma, linear_, light_);
  } else {
    copy_luma(frame.luma, held_);
  }
  return {};
}

void Decoder::finish_axis(OneAxis& axis) {
  axis.found = axis.decoder->finish(light_, options_);
  axis.decoder.reset();
}

Expected<Correspondence> Decoder::finish() {
  if (next_ < sequence_.patterns.size())
    return input_error("the frame of pattern " + describe(sequence_.patterns[next_]) + " is missing");
  Correspondence found{.camera = light_.contrast.size(),
                       .projector = sequence_.projector,
                       .rows = {},
                       .columns = {},
                       .response = response_,
                       .pixels_lit = light_.pixels_lit,
                       .pixels_decoded = 0};
  held_ = {};
  white_ = {};
  black_ = {};
  middle_ = {};
  for (OneAxis* axis : {&rows_, &columns_})
    if (axis->decoder) finish_axis(*axis);
  found.rows = std::move(rows_.found);
  found.columns = std::move(columns_.found);
  light_ = {};
  found.pixels_decoded = count_decoded(found);
  return found;
}

}  // namespace bodyscan
