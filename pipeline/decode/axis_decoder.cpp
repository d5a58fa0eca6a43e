#include "pipeline/decode/axis_decoder.hpp"

#include "pipeline/decode/camera_blur.hpp"
#include "pipeline/decode/local_fit.hpp"
#include "pipeline/decode/outshone.hpp"
#include "pipeline/decode/phase_locator.hpp"
#include "pipeline/decode/stripe_locator.hpp"

#include <limits>
#include <utility>

namespace bodyscan {
namespace {

// Of one picture, from that of twice a picture less white and black as of MiddleLight.
NoiseModel picture_noise(const NoiseModel& difference, float middle_variance) {
  const float share = 1 / (4 + middle_variance);
  return {share * difference.constant, share * difference.slope};
}

}  // namespace

AxisDecoder::AxisDecoder(Size camera, int count, const std::optional<PhaseCode>& phase)
    : count_(count),
      planes_(std::in_place, camera, gray_bits(count), phase ? phase->finest_bit : 0),
      sampled_(camera) {
  if (phase) phase_.emplace(camera, *phase);
  // Written to, so that the system hands the memory out now and not after the last frame.
  constexpr float none = std::numeric_limits<float>::quiet_NaN();
  result_ = {FloatImage(camera, none), FloatImage(camera, none)};
}

void AxisDecoder::add(int bit, const Luma& pattern, const Luma& inverse,
                      std::span<const std::uint16_t> linear, const Illumination& light) {
  planes_->add(bit, pattern, inverse, linear);
  taken(bit, light);
}

void AxisDecoder::add_against(int bit, const Luma& pattern, const MiddleLight& middle,
                              std::span<const std::uint16_t> linear, const Illumination& light) {
  planes_->add_against(bit, pattern, middle.twice(), linear);
  middle_variance_ = middle.variance();
  taken(bit, light);
}

void AxisDecoder::add_step(int step, const Luma& picture, std::span<const std::uint16_t> linear,
                           const Illumination& light, MiddleLight& middle) {
  phase_->add(step, picture, linear);
  if (step < phase_->code().steps - 1) return;
  middle.refine(*phase_, light.contrast);
  amplitude_.emplace(*phase_, light.contrast);
  harmonic_.emplace(*phase_, light.contrast);
}

void AxisDecoder::rescale(const Image<std::uint16_t>& before, const Image<std::uint16_t>& now) {
  planes_->rescale(before, now);
  energy_.reset();
}

void AxisDecoder::taken(int bit, const Illumination& light) {
  if (bit == finest_bit() + 1) measure_coarser_bits(light);
  complete_ = bit == finest_bit();
}

void AxisDecoder::measure_coarser_bits(const Illumination& light) {
  noise_ = measure_noise(*planes_, light.contrast);
  if (phase_) return;
  energy_.emplace(light.contrast, noise_);
  for (int bit = 1; bit < StripePlanes::fine_bits; ++bit)
    energy_->add(bit, planes_->fine[static_cast<std::size_t>(bit)], light.contrast);
}

StripeResolution AxisDecoder::resolve(const Illumination& light, const DecodeOptions& options) {
  if (phase_) return uniform_resolution(light.contrast.size(), finest_bit());
  if (!energy_) measure_coarser_bits(light);
  energy_->add(0, planes_->fine.front(), light.contrast);
  return energy_->resolve(planes_->bit_count, options.max_dropped_bits);
}

AxisCorrespondence AxisDecoder::finish(const Illumination& light, const DecodeOptions& options) {
  const Image<std::uint16_t>& contrast = light.contrast;
  const StripeLocator locator(*planes_, contrast, noise_, resolve(light, options), count_, options);
  std::optional<PhaseLocator> phase;
  if (phase_)
    phase.emplace(*phase_, *amplitude_, *harmonic_, contrast, picture_noise(noise_, middle_variance_));
  const CoordinateRows as_seen = [&](const RowRange& rows, const RowArrays& arrays) {
    locator.locate(rows, arrays);
    if (phase) phase->refine(rows, arrays);
    drop_outshone(contrast, options.brightness_edges, rows, arrays);
  };
  sampled_->measure(as_seen);
  const GradientMap gradients(*sampled_, contrast);
  const CameraBlur blur = measure_camera_blur(*sampled_, gradients, contrast, noise_);
  const CoordinateRows sharpened = [&](const RowRange& rows, const RowArrays& arrays) {
    as_seen(rows, arrays);
    correct_camera_blur(blur, gradients, contrast, rows, arrays);
  };
  AxisCorrespondence result = std::move(result_);
  fit_locally(sharpened, gradients.px_per_unit(), options.fit, result);
  planes_.reset();
  phase_.reset();
  energy_.reset();
  sampled_.reset();
  return result;
}

}  // namespace bodyscan
