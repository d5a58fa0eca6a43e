#include "tools/simulator/render_options.hpp"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

namespace bodyscan::simulator {
namespace {

TEST(RenderOptions, TheDefaultsAreLegal) {
  EXPECT_TRUE(RenderOptions{}.check());
}

TEST(RenderOptions, AnErrorNamesItsOption) {
  const std::vector<std::pair<std::string, std::function<void(RenderOptions&)>>> cases{
      {"--detail: must lie in 0.05 to 20", [](RenderOptions& o) { o.detail = 0; }},
      {"--scale-subject", [](RenderOptions& o) { o.subject_scale = -1; }},
      {"--light", [](RenderOptions& o) { o.light = -0.1; }},
      {"--contrast", [](RenderOptions& o) { o.contrast = 0.5; }},
      {"--ambient", [](RenderOptions& o) { o.ambient = std::nan(""); }},
      {"--reflection", [](RenderOptions& o) { o.reflection = 1.1; }},
      {"--defocus", [](RenderOptions& o) { o.defocus = -1; }},
      {"--subsurface:", [](RenderOptions& o) { o.subsurface = 1.5; }},
      {"--subsurface-blur", [](RenderOptions& o) { o.subsurface_blur = -1; }},
      {"--uneven-light: must lie in 0 to 1", [](RenderOptions& o) { o.uneven_light = 1.1; }},
      {"--lens-blur: must lie in 0 to 50", [](RenderOptions& o) { o.lens_blur = -0.1; }},
      {"--rays", [](RenderOptions& o) { o.rays = 0; }},
      {"--full-well", [](RenderOptions& o) { o.full_well = -1; }},
      {"--read-noise", [](RenderOptions& o) { o.read_noise = -1; }},
      {"--jpeg-quality: must lie in 1 to 100", [](RenderOptions& o) { o.jpeg_quality = 101; }},
      {"--pose", [](RenderOptions& o) { o.pose_rotation.x() = INFINITY; }},
      {"--motion", [](RenderOptions& o) { o.motion.z() = std::nan(""); }},
      {"--material", [](RenderOptions& o) { o.material = "glass"; }},
      {"--axes", [](RenderOptions& o) { o.sequence.rows = false; }},
  };
  for (const auto& [wanted, spoil] : cases) {
    RenderOptions options;
    spoil(options);
    const Expected<void> checked = options.check();
    ASSERT_FALSE(checked) << wanted;
    EXPECT_EQ(checked.error().kind, ErrorKind::usage);
    EXPECT_TRUE(checked.error().message.starts_with(wanted)) << checked.error().message;
  }
}

}  // namespace
}  // namespace bodyscan::simulator
