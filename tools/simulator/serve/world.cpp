#include "tools/simulator/serve/world.hpp"

#include "pipeline/image/srgb.hpp"
#include "tools/simulator/image_files.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace bodyscan::simulator {
namespace {

constexpr int any_width = std::numeric_limits<int>::max();
constexpr int preview_width = 640;    // the D5000's live view
constexpr int thumbnail_width = 160;  // the D5000's, and Exif's
constexpr int small_picture_quality = 85;

std::array<float, 256> linear_table() {
  std::array<float, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] = static_cast<float>(srgb_to_linear(static_cast<double>(i) / 255));
  return table;
}

FloatImage linear_light(const LightMix& mix) {
  static const std::array<float, 256> linear = linear_table();
  FloatImage light(mix.front().picture->pixels.size(), 0);
  for (const PictureShare& part : mix) {
    const auto share = static_cast<float>(part.share);
    const auto codes = part.picture->pixels.pixels();
    for (std::size_t i = 0; i < codes.size(); ++i) light.pixels()[i] += share * linear[codes[i]];
  }
  return light;
}

// Of the noise: of the light alone.
int noise_seed(const LightMix& mix) {
  std::uint64_t key = 0;
  for (const PictureShare& part : mix) key ^= part.picture->key;
  return static_cast<int>(key % std::numeric_limits<int>::max());
}

Lens narrowed(const Lens& lens, int most_width) {
  if (lens.size.width <= most_width) return lens;
  const double scale = static_cast<double>(most_width) / lens.size.width;
  Lens small = lens;
  small.size = {most_width, std::max(1, static_cast<int>(lens.size.height * scale))};
  small.fx *= scale;
  small.fy *= scale;
  small.cx = (lens.cx + 0.5) * scale - 0.5;
  small.cy = (lens.cy + 0.5) * scale - 0.5;
  return small;
}

// The mean of all pixels that fall into each of the smaller picture's.
ColorImage8 shrunk(const ColorImage8& image, int most_width) {
  if (image.width() <= most_width) return image.clone();
  const Size size{most_width, std::max(1, image.height() * most_width / image.width())};
  ColorImage8 small(size);
  for (int y = 0; y < size.height; ++y) {
    const int top = y * image.height() / size.height;
    const int bottom = (y + 1) * image.height() / size.height;
    for (int x = 0; x < size.width; ++x) {
      const int left = x * image.width() / size.width;
      const int right = (x + 1) * image.width() / size.width;
      std::array<int, 3> sum{};
      for (int v = top; v < bottom; ++v) {
        for (int u = left; u < right; ++u) {
          for (unsigned c = 0; c < 3; ++c) sum[c] += image(u, v)[c];
        }
      }
      for (unsigned c = 0; c < 3; ++c)
        small(x, y)[c] = static_cast<std::uint8_t>(sum[c] / ((bottom - top) * (right - left)));
    }
  }
  return small;
}

SharedBytes jpeg_of(const ColorImage8& image, int quality) {
  return std::make_shared<const ptp::Bytes>(encode_jpeg(image, quality).value());
}

}  // namespace

Expected<World::Place> World::place(const RenderOptions& options, double displacement, int most_width) {
  RenderOptions own = options;
  own.pose_translation.x() += displacement;
  Expected<Scene> scene = make_scene(own);
  if (!scene) return tl::unexpected(scene.error());
  auto kept = std::make_unique<Scene>(std::move(*scene));
  kept->calibration.camera = narrowed(kept->calibration.camera, most_width);
  Expected<Renderer> renderer = Renderer::make(*kept, own);
  if (!renderer) return tl::unexpected(renderer.error());
  return Place{displacement, std::move(kept), std::move(*renderer)};
}

Expected<std::unique_ptr<World>> World::make(const RenderOptions& options,
                                             const std::vector<double>& displacements) {
  std::unique_ptr<World> world(new World(options));
  std::vector<double> all{0};
  all.insert(all.end(), displacements.begin(), displacements.end());
  for (const double displacement : all) {
    Expected<Place> made = place(options, displacement, any_width);
    if (!made) return tl::unexpected(made.error());
    world->places_.push_back(std::move(*made));
  }
  return world;
}

Photo World::photograph(const LightMix& light, double gain, double displacement) const {
  const auto found = std::ranges::find(places_, displacement, &Place::displacement);
  const Place& place = found == places_.end() ? places_.front() : *found;
  const ColorImage8 image =
      place.renderer.frame(linear_light(light), noise_seed(light), static_cast<float>(gain));
  const ColorImage8 thumbnail = shrunk(image, thumbnail_width);
  return {jpeg_of(image, options_.jpeg_quality), image.size(), jpeg_of(thumbnail, small_picture_quality),
          thumbnail.size()};
}

SharedBytes World::preview(const LightMix& light, double gain, double displacement) {
  if (!preview_ || preview_->displacement != displacement)
    preview_ = std::make_unique<Place>(place(options_, displacement, preview_width).value());
  return jpeg_of(preview_->renderer.frame(linear_light(light), noise_seed(light), static_cast<float>(gain)),
                 small_picture_quality);
}

}  // namespace bodyscan::simulator
