#include "tools/simulator/serve/world.hpp"

#include "tests/support/temporary_folder.hpp"
#include "tools/simulator/image_files.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace bodyscan::simulator {
namespace {

RenderOptions small_options() {
  RenderOptions options;
  options.subject = "builtin:staircase";
  options.rig.scale = 0.05;
  options.rig.projector = {256, 192};
  return options;
}

LightMix uniform(std::uint8_t code) {
  return {{make_picture(GrayImage8({256, 192}, code)), 1}};
}

// Decoded and averaged over the picture: sRGB codes.
double mean_code(const Photo& photo) {
  const TemporaryFolder folder;
  EXPECT_TRUE(write_bytes(folder / "photo.jpg", *photo.jpeg));
  const ColorImage8 image = read_color_image(folder / "photo.jpg").value();
  EXPECT_EQ(image.size(), photo.size);
  double sum = 0;
  for (const Rgb8& pixel : image.pixels()) sum += pixel[1];
  return sum / static_cast<double>(image.size().area());
}

TEST(World, APhotoOfAPatternIsWhatRenderWrites) {
  const RenderOptions options = small_options();
  const auto world = World::make(options, {}).value();
  EXPECT_EQ(world->camera_size(), (Size{214, 142}));
  EXPECT_EQ(world->projector_size(), (Size{256, 192}));
  const Scene scene = make_scene(options).value();
  const Renderer renderer = Renderer::make(scene, options).value();
  for (const Pattern& pattern :
       {Pattern{.kind = PatternKind::white}, Pattern{PatternKind::gray, Axis::row, 2, false}}) {
    const Picture picture = make_picture(render_pattern(pattern, {256, 192}));
    const int noise = static_cast<int>(picture->key % std::numeric_limits<int>::max());
    const ptp::Bytes wanted = encode_jpeg(renderer.frame(pattern, noise), options.jpeg_quality).value();
    EXPECT_EQ(*world->photograph({{picture, 1}}, 1, 0).jpeg, wanted) << describe(pattern);
  }
}

TEST(World, BrightnessFollowsGainAndLight) {
  const auto world = World::make(small_options(), {}).value();
  const double white = mean_code(world->photograph(uniform(255), 1, 0));
  EXPECT_LT(mean_code(world->photograph(uniform(0), 1, 0)), white / 3);
  EXPECT_LT(mean_code(world->photograph(uniform(255), 0.1, 0)), white / 2);
  EXPECT_GT(mean_code(world->photograph(uniform(255), 4, 0)), white * 1.05);
  // Half of white's light is the light of sRGB code 188.
  LightMix half = uniform(255);
  half[0].share = 0.5;
  half.push_back({uniform(0)[0].picture, 0.5});
  EXPECT_NEAR(mean_code(world->photograph(half, 1, 0)), mean_code(world->photograph(uniform(188), 1, 0)),
              0.5);
}

TEST(World, ADisplacedSubjectIsAnotherPicture) {
  const auto world = World::make(small_options(), {3}).value();
  EXPECT_NE(*world->photograph(uniform(255), 1, 3).jpeg, *world->photograph(uniform(255), 1, 0).jpeg);
}

TEST(World, PreviewsAndThumbnailsAreSmall) {
  RenderOptions options = small_options();
  options.rig.scale = 0.2;
  options.rays = 1;
  const auto world = World::make(options, {}).value();
  const Photo photo = world->photograph(uniform(255), 1, 0);
  EXPECT_EQ(photo.thumbnail_size.width, 160);
  const TemporaryFolder folder;
  ASSERT_TRUE(write_bytes(folder / "thumbnail.jpg", *photo.thumbnail));
  EXPECT_EQ(read_color_image(folder / "thumbnail.jpg").value().size(), photo.thumbnail_size);
  ASSERT_TRUE(write_bytes(folder / "preview.jpg", *world->preview(uniform(255), 1, 0)));
  EXPECT_EQ(read_color_image(folder / "preview.jpg").value().width(), 640);
}

}  // namespace
}  // namespace bodyscan::simulator
