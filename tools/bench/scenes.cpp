#include "tools/bench/scenes.hpp"

#include <algorithm>
#include <utility>

namespace bodyscan {
namespace {

using simulator::RenderOptions;

RenderOptions subject(const std::string& name, double scale) {
  RenderOptions options;
  options.subject = "builtin:" + name;
  options.rig.scale = scale;
  return options;
}

RenderOptions blurred(RenderOptions options) {
  options.defocus = 1.6;
  options.subsurface = 0.8;
  return options;
}

RenderOptions dim(RenderOptions options) {
  options.light = 0.06;
  options.defocus = 1.1;
  options.jpeg_quality = 88;
  options.rig.projector = {800, 600};
  return options;
}

RenderOptions skin(RenderOptions options) {
  options.material = "skin";
  return options;
}

RenderOptions seen_from(const std::string& rig, bool rows, bool columns, RenderOptions options) {
  options.calibration = "builtin:" + rig;
  options.rig.name = rig;
  options.sequence.rows = rows;
  options.sequence.columns = columns;
  return options;
}

RenderOptions fast(RenderOptions options) {
  options.sequence = fast_sequence;
  return options;
}

RenderOptions rolled(double degrees, RenderOptions options) {
  options.rig.projector_roll = degrees;
  return options;
}

}  // namespace

std::vector<BenchScene> accuracy_scenes(double scale) {
  const RenderOptions spheres = subject("spheres", scale);
  const RenderOptions head = subject("head", scale);
  return {
      {"spheres", "plate and spheres, matt", spheres},
      {"staircase", "staircase", subject("staircase", scale)},
      {"skin_head", "skin, head", head},
      {"skin_torso", "skin, torso", subject("torso", scale)},
      {"skin_forearm", "skin, forearm", subject("forearm", scale)},
      {"blur", "skin, strong blur", blurred(head)},
      {"dim", "skin, dim 800 x 600 projector", dim(head)},
      {"columns", "columns instead of rows", seen_from("columns", false, true, spheres)},
      {"both", "rows and columns", seen_from("diagonal", true, true, spheres)},
      {"bumps", "bumps, matt", subject("bumps", scale)},
      {"bumps_skin", "bumps, skin", skin(subject("bumps", scale))},
      {"fast", "plate and spheres, 15 pictures", fast(spheres)},
      {"fast_skin", "skin, head, 15 pictures", fast(head)},
      {"roll_90", "projector turned by 90 degrees", rolled(90, spheres)},
      {"roll_180", "projector turned by 180 degrees", rolled(180, spheres)},
      {"roll_30", "projector turned by 30 degrees", rolled(30, spheres)},
  };
}

Expected<BenchScene> bench_scene(const std::string& name, double scale) {
  std::vector<BenchScene> scenes = accuracy_scenes(scale);
  RenderOptions speed = subject("torso", scale);
  speed.subject_scale = 1.1;
  RenderOptions growth = speed;
  speed.sequence.columns = true;
  growth.rays = 1;
  growth.write_mesh = false;
  scenes.push_back({"speed", "torso that fills half of the picture", speed});
  scenes.push_back({"growth", "torso that fills half of the picture", growth});
  const auto found = std::ranges::find(scenes, name, &BenchScene::name);
  if (found == scenes.end()) return tl::unexpected(Error{ErrorKind::usage, "no scene " + name});
  return std::move(*found);
}

}  // namespace bodyscan
