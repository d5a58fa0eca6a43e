#include "pipeline/preview/false_color.hpp"

#include "pipeline/base/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace bodyscan {
namespace {

struct Scale {
  float low;
  float high;
};

std::uint8_t level(float share) {
  return static_cast<std::uint8_t>(std::lround(255 * share));
}

// From green over cyan to blue.
Rgb8 green_to_blue(float value, Scale scale) {
  const float t = std::clamp((value - scale.low) / std::max(scale.high - scale.low, 1e-6F), 0.F, 1.F);
  return {0, level(std::min(1.F, 2 - 2 * t)), level(std::min(1.F, 2 * t))};
}

// Blocks of factor x factor values, NaN left out.
template <class ValueAt>
ColorImage8 paint(Size size, int max_width, Scale scale, const ValueAt& value_at) {
  const int factor = std::max(1, (size.width + max_width - 1) / max_width);
  ColorImage8 picture(Size{(size.width + factor - 1) / factor, (size.height + factor - 1) / factor});
  parallel_for(0, picture.height(), 16, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      for (int x = 0; x < picture.width(); ++x) {
        float sum = 0;
        int count = 0;
        for (int v = y * factor; v < std::min((y + 1) * factor, size.height); ++v) {
          for (int u = x * factor; u < std::min((x + 1) * factor, size.width); ++u) {
            const float value = value_at(u, v);
            if (std::isnan(value)) continue;
            sum += value;
            ++count;
          }
        }
        picture(x, y) = count == 0 ? Rgb8{0, 0, 0} : green_to_blue(sum / static_cast<float>(count), scale);
      }
    }
  });
  return picture;
}

// Depths between which all vertices but a per cent on either side lie, from a sample of them.
Scale depth_range(const GridMesh& mesh) {
  const std::size_t step = std::max<std::size_t>(1, mesh.size().area() / 500'000);
  std::vector<float> depths;
  for (std::size_t i = 0; i < mesh.size().area(); i += step) {
    if (mesh.cells().data()[i] & cell::used) depths.push_back(mesh.grid().points.data()[i].z);
  }
  if (depths.empty()) return {0, 1};
  const auto percentile = [&](std::size_t per_cent) {
    const auto nth = depths.begin() + static_cast<std::ptrdiff_t>((depths.size() - 1) * per_cent / 100);
    std::nth_element(depths.begin(), nth, depths.end());
    return *nth;
  };
  return {percentile(1), percentile(99)};
}

}  // namespace

ColorImage8 depth_picture(const GridMesh& mesh, int max_width) {
  return paint(mesh.size(), max_width, depth_range(mesh), [&](int x, int y) {
    return mesh.has(x, y) ? mesh.grid().points(x, y).z : std::numeric_limits<float>::quiet_NaN();
  });
}

ColorImage8 coordinate_picture(const FloatImage& coordinate, int count, int max_width) {
  return paint(coordinate.size(), max_width, {0, static_cast<float>(count - 1)},
               [&](int x, int y) { return coordinate(x, y); });
}

}  // namespace bodyscan
