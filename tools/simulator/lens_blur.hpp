#pragma once

#include "pipeline/base/image.hpp"

#include <array>

namespace bodyscan::simulator {

// Linear light a pixel and channel, 1 = full scale.
using LightImage = Image<std::array<float, 3>>;

// How many pixels light spreads to either side under a blur of `sigma_px`.
int lens_blur_reach(double sigma_px);

// Blurs by a Gaussian of standard deviation `sigma_px` > 0, cut off at lens_blur_reach. Beyond its edge the
// picture goes on as its outermost pixels.
void blur_light(LightImage& image, double sigma_px);

}  // namespace bodyscan::simulator
