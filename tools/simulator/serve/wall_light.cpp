#include "tools/simulator/serve/wall_light.hpp"

#include <algorithm>

namespace bodyscan::simulator {
namespace {

void add(LightMix& mix, const Picture& picture, double share) {
  if (share <= 0) return;
  for (PictureShare& part : mix) {
    if (part.picture->key == picture->key) {
      part.share += share;
      return;
    }
  }
  mix.push_back({picture, share});
}

void normalise(LightMix& mix) {
  constexpr double least = 1e-6;  // what is less is rounding
  double sum = 0;
  for (const PictureShare& part : mix) sum += part.share;
  std::erase_if(mix, [&](const PictureShare& part) { return part.share < least * sum; });
  for (PictureShare& part : mix) part.share = mix.size() == 1 ? 1 : part.share / sum;
}

}  // namespace

Picture make_picture(GrayImage8 pixels) {
  std::uint64_t key = 0xCBF29CE484222325ULL;  // FNV-1a
  for (const std::uint8_t pixel : pixels.pixels()) key = (key ^ pixel) * 0x100000001B3ULL;
  return std::make_shared<const ShownPicture>(ShownPicture{std::move(pixels), key});
}

WallLight::WallLight(Picture first, Clock::duration latency, Clock::duration rise)
    : latency_(latency), rise_(rise) {
  const LightMix before{{first, 1}};
  changes_.push_back({std::move(first), Moment::min(), before});
}

void WallLight::show(Picture picture, Moment moment) {
  const Moment begin = moment + latency_;
  changes_.push_back({std::move(picture), begin, light_at(begin)});
}

// The share of a change's picture at a moment after its begin.
double WallLight::risen(const Change& change, Moment moment) const {
  if (change.begin == Moment::min() || moment >= change.begin + rise_) return 1;
  return seconds(moment - change.begin) / seconds(rise_);
}

LightMix WallLight::light_at(Moment moment) const {
  const auto current = std::find_if(changes_.rbegin(), changes_.rend() - 1,
                                    [&](const Change& change) { return change.begin <= moment; });
  const double share = risen(*current, moment);
  LightMix mix;
  for (const PictureShare& part : current->before) add(mix, part.picture, part.share * (1 - share));
  add(mix, current->picture, share);
  return mix;
}

LightMix WallLight::mean(Moment begin, Moment end) const {
  if (end <= begin) return light_at(begin);
  LightMix mix;
  for (std::size_t i = 0; i < changes_.size(); ++i) {
    const Change& change = changes_[i];
    const Moment from = std::max(begin, change.begin);
    const Moment to = i + 1 < changes_.size() ? std::min(end, changes_[i + 1].begin) : end;
    if (to <= from) continue;
    // While the picture rises its share grows linearly, so the mean is that of both ends.
    const Moment full = change.begin == Moment::min() ? from : std::clamp(change.begin + rise_, from, to);
    const double rising = seconds(full - from) * (risen(change, from) + risen(change, full)) / 2;
    const double share = rising + seconds(to - full);
    add(mix, change.picture, share);
    for (const PictureShare& part : change.before)
      add(mix, part.picture, part.share * (seconds(to - from) - share));
  }
  normalise(mix);
  return mix;
}

void WallLight::forget_before(Moment moment) {
  while (changes_.size() > 1 && changes_[1].begin <= moment) changes_.pop_front();
}

}  // namespace bodyscan::simulator
