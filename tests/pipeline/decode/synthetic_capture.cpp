#include "tests/pipeline/decode/synthetic_capture.hpp"

#include "pipeline/decode/decoder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

namespace bodyscan {
namespace {

// A step at 0, spread by a Gaussian.
double edge(double distance, double blur) {
  return blur > 0 ? 0.5 * std::erfc(-distance / (blur * std::numbers::sqrt2)) : distance > 0 ? 1 : 0;
}

// Light at `position` from rows 0 to count - 1, those whose bit of the Gray code is 1 lit; bit < 0: all lit.
double stripes(int bit, int count, double position, double blur) {
  const double reach = 6 * blur + 1;
  const double end = count - 0.5;
  if (bit < 0) return edge(position + 0.5, blur) - edge(position - end, blur);
  const double half = std::ldexp(1.0, bit);
  // A period of 4 half keeps exp(-2 pi^2 blur^2 / period^2) of its contrast.
  if (blur > 5 * half) return 0.5 * stripes(-1, count, position, blur);
  // The bit changes at rows half, 3 half, 5 half, ...
  auto change = static_cast<long>(std::max(0.0, std::floor((position - reach + 0.5 - half) / (2 * half))));
  double light = static_cast<double>(change % 2);
  double sign = change % 2 == 0 ? 1 : -1;
  for (;; ++change, sign = -sign) {
    const double place = half * static_cast<double>(2 * change + 1) - 0.5;
    if (place >= end || place > position + reach) break;
    light += sign * edge(position - place, blur);
  }
  const bool lit_at_end =
      pattern_is_white({PatternKind::gray, Axis::row, bit, false}, static_cast<unsigned>(count - 1));
  return lit_at_end ? light - edge(position - end, blur) : light;
}

// The same from the rows that a phase step lights.
double phase_stripes(const Pattern& pattern, int count, double position, double blur) {
  const int lit = pattern.period_px / 2;
  if (blur > 2 * pattern.period_px) return stripes(-1, count, position, blur) * lit / pattern.period_px;
  const double reach = 6 * blur + 1;
  const int first = std::max(0, static_cast<int>(std::floor(position - reach)));
  const int last = std::min(count - 1, static_cast<int>(std::ceil(position + reach)));
  double light = 0;
  for (int row = first; row <= last; ++row)
    if (pattern_is_white(pattern, static_cast<unsigned>(row)))
      light += edge(position - row + 0.5, blur) - edge(position - row - 0.5, blur);
  return light;
}

double pattern_light(const Pattern& pattern, Size projector, const Sight& sight, double position,
                     double blur) {
  if (pattern.kind == PatternKind::black) return 0;
  const int count = pattern.axis == Axis::row ? projector.height : projector.width;
  const double white = stripes(-1, count, position, blur);
  if (pattern.kind == PatternKind::white || sight.albedo == 0) return white;
  if (pattern.kind == PatternKind::phase) return phase_stripes(pattern, count, position, blur);
  const double lit = stripes(pattern.bit, count, position, blur);
  return pattern.inverted ? white - lit : lit;
}

double light_at(const Pattern& pattern, Size projector, const Sight& sight) {
  const bool row = pattern.axis == Axis::row;
  const double position = row ? sight.row : sight.column;
  double light = 0;
  if (!sight.shadow) {
    light = (1 - sight.wide_share) * pattern_light(pattern, projector, sight, position, sight.blur_px);
    if (sight.wide_share > 0)
      light += sight.wide_share * pattern_light(pattern, projector, sight, position, sight.wide_px);
  }
  if (sight.scattered > 0)
    light +=
        sight.scattered * pattern_light(pattern, projector, sight, sight.scattered_row, sight.scattered_px);
  return sight.albedo * light;
}

double encode(const ToneResponse& response, double light) {
  switch (response.kind) {
    case ToneResponse::Kind::srgb:
      return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
    case ToneResponse::Kind::gamma:
      return std::pow(light, 1 / response.gamma);
    case ToneResponse::Kind::linear:
      break;
  }
  return light;
}

// Convolves with a Gaussian along one direction of the picture; the border is repeated.
FloatImage spread(const FloatImage& image, double blur, int dx, int dy) {
  constexpr int reach = 3;
  std::array<double, 2 * reach + 1> weights{};
  double total = 0;
  for (int i = -reach; i <= reach; ++i)
    total += weights[static_cast<std::size_t>(i + reach)] = std::exp(-0.5 * i * i / (blur * blur));
  FloatImage result(image.size());
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      double sum = 0;
      for (int i = -reach; i <= reach; ++i)
        sum += weights[static_cast<std::size_t>(i + reach)] *
               image(std::clamp(x + i * dx, 0, image.width() - 1),
                     std::clamp(y + i * dy, 0, image.height() - 1));
      result(x, y) = static_cast<float>(sum / total);
    }
  }
  return result;
}

FloatImage light_of(const Pattern& pattern, const Image<Sight>& sights, const CaptureOptions& options) {
  FloatImage light(options.camera);
  for (std::size_t i = 0; i < options.camera.area(); ++i)
    light.data()[i] =
        static_cast<float>(options.ambient + light_at(pattern, options.projector, sights.data()[i]));
  if (options.camera_blur <= 0) return light;
  return spread(spread(light, options.camera_blur, 1, 0), options.camera_blur, 0, 1);
}

template <class Pixel>
Luma photograph(const Pattern& pattern, const Image<Sight>& sights, const CaptureOptions& options,
                std::mt19937& random) {
  std::normal_distribution<double> normal;
  const FloatImage clean = light_of(pattern, sights, options);
  Image<Pixel> image(options.camera);
  for (std::size_t i = 0; i < options.camera.area(); ++i) {
    double light = clean.data()[i];
    const double variance = options.read_noise * options.read_noise + options.shot_noise * light;
    if (variance > 0) light += std::sqrt(variance) * normal(random);
    const double value = encode(options.response, std::clamp(light, 0.0, 1.0));
    image.data()[i] = static_cast<Pixel>(std::lround(value * std::numeric_limits<Pixel>::max()));
  }
  return image;
}

}  // namespace

Scene plane_scene(const CaptureOptions& options, double turn_degrees, double px_per_row) {
  const double angle = turn_degrees * std::numbers::pi / 180;
  const double across = std::cos(angle) / px_per_row;
  const double down = std::sin(angle) / px_per_row;
  const double middle_x = 0.5 * options.camera.width;
  const double middle_y = 0.5 * options.camera.height;
  const Size projector = options.projector;
  return [=](int x, int y) {
    const double dx = x - middle_x;
    const double dy = y - middle_y;
    Sight sight;
    sight.row = 0.4713 * projector.height + dy * across - dx * down;
    sight.column = 0.5391 * projector.width + dx * across + dy * down;
    return sight;
  };
}

PatternSequence sequence_of(const CaptureOptions& options) {
  auto sequence = make_sequence(options.projector, options.sequence);
  if (!sequence) throw std::runtime_error(sequence.error().message);
  return *std::move(sequence);
}

std::vector<Frame> capture(const Scene& scene, const CaptureOptions& options) {
  Image<Sight> sights(options.camera);
  for (int y = 0; y < options.camera.height; ++y)
    for (int x = 0; x < options.camera.width; ++x) sights(x, y) = scene(x, y);
  std::mt19937 random(options.seed);
  std::vector<Frame> frames;
  for (const Pattern& pattern : sequence_of(options).patterns)
    frames.push_back({pattern, options.bits == 8
                                   ? photograph<std::uint8_t>(pattern, sights, options, random)
                                   : photograph<std::uint16_t>(pattern, sights, options, random)});
  return frames;
}

Correspondence decode(const std::vector<Frame>& frames, const PatternSequence& sequence,
                      const DecodeOptions& decoding) {
  auto decoder = Decoder::create(sequence, decoding);
  if (!decoder) throw std::runtime_error(decoder.error().message);
  for (const Frame& frame : frames)
    if (const auto taken = decoder->consume(frame); !taken) throw std::runtime_error(taken.error().message);
  auto found = decoder->finish();
  if (!found) throw std::runtime_error(found.error().message);
  return *std::move(found);
}

Correspondence decode(const Scene& scene, const CaptureOptions& options, DecodeOptions decoding) {
  decoding.response = options.response;
  return decode(capture(scene, options), sequence_of(options), decoding);
}

Comparison compare(const AxisCorrespondence& measured, Axis axis, const Scene& scene,
                   const std::function<bool(int, int)>& where) {
  Comparison result;
  double squares = 0;
  double sum = 0;
  double variances = 0;
  for (int y = 0; y < measured.coordinate.height(); ++y) {
    for (int x = 0; x < measured.coordinate.width(); ++x) {
      if (!where(x, y)) continue;
      const double value = measured.coordinate(x, y);
      if (std::isnan(value)) {
        ++result.undecided;
        continue;
      }
      const Sight sight = scene(x, y);
      const double error = value - (axis == Axis::row ? sight.row : sight.column);
      const double sigma = measured.sigma(x, y);
      ++result.pixels;
      sum += error;
      squares += error * error;
      variances += sigma * sigma;
      result.worst = std::max(result.worst, std::abs(error));
    }
  }
  const double count = std::max(1, result.pixels);
  result.mean = sum / count;
  result.rms = std::sqrt(squares / count);
  result.mean_sigma = std::sqrt(variances / count);
  return result;
}

std::function<bool(int, int)> interior(Size camera, int margin) {
  return [=](int x, int y) {
    return x >= margin && y >= margin && x < camera.width - margin && y < camera.height - margin;
  };
}

}  // namespace bodyscan
