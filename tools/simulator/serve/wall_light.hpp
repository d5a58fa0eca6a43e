#pragma once

#include "pipeline/base/image.hpp"
#include "tools/simulator/serve/moment.hpp"

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

namespace bodyscan::simulator {

// A picture that a projector was given: 0 black to 255 white, sRGB.
struct ShownPicture {
  GrayImage8 pixels;
  std::uint64_t key = 0;  // of its content
};
using Picture = std::shared_ptr<const ShownPicture>;

Picture make_picture(GrayImage8 pixels);

// Linear light as shares of pictures; the shares' sum is 1.
struct PictureShare {
  Picture picture;
  double share = 0;
};
using LightMix = std::vector<PictureShare>;

// What a projector throws on the wall over time. A picture shown at t begins to appear at t + latency and is
// fully on a rise time later; meanwhile its light takes over linearly from what was there.
class WallLight {
 public:
  WallLight(Picture first, Clock::duration latency, Clock::duration rise);

  // Moments must not go back.
  void show(Picture picture, Moment moment);
  // The mean light from `begin` to `end`, both not before what was forgotten.
  [[nodiscard]] LightMix mean(Moment begin, Moment end) const;
  // Lets go of what nobody will ask for: all that was on before `moment`.
  void forget_before(Moment moment);

 private:
  struct Change {
    Picture picture;
    Moment begin;     // when the picture begins to appear
    LightMix before;  // what is on then
  };

  [[nodiscard]] double risen(const Change& change, Moment moment) const;
  [[nodiscard]] LightMix light_at(Moment moment) const;

  Clock::duration latency_;
  Clock::duration rise_;
  std::deque<Change> changes_;  // never empty
};

}  // namespace bodyscan::simulator
