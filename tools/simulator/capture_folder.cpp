#include "tools/simulator/capture_folder.hpp"

#include "pipeline/base/parallel.hpp"
#include "pipeline/calibration/calibration_file.hpp"
#include "tools/simulator/frame_file.hpp"
#include "tools/simulator/image_files.hpp"
#include "tools/simulator/json_values.hpp"
#include "tools/simulator/option_range.hpp"
#include "tools/simulator/sensor.hpp"
#include "tools/simulator/skin.hpp"
#include "tools/simulator/subjects.hpp"

#include <charconv>
#include <fstream>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

namespace bodyscan::simulator {
namespace {

namespace fs = std::filesystem;

std::string frame_name(int index, FrameFormat format) {
  const std::string number = std::to_string(index);
  return "frame_" + (number.size() < 2 ? "0" + number : number) + extension(format);
}

Json capture_json(const PatternSequence& sequence, FrameFormat format) {
  Json capture{{"format", "bodyscan-capture"},
               {"version", 1},
               {"projector", {{"width", sequence.projector.width}, {"height", sequence.projector.height}}},
               {"camera", "simulated Nikon D5000"},
               {"frames", Json::array()}};
  int index = 0;
  for (const Pattern& pattern : sequence.patterns) {
    Json frame{{"file", frame_name(index++, format)}};
    switch (pattern.kind) {
      case PatternKind::white:
        frame["pattern"] = "white";
        break;
      case PatternKind::black:
        frame["pattern"] = "black";
        break;
      case PatternKind::gray:
        frame["pattern"] = "gray";
        frame["axis"] = pattern.axis == Axis::row ? "row" : "column";
        frame["bit"] = pattern.bit;
        frame["inverted"] = pattern.inverted;
        break;
      case PatternKind::phase:
        frame["pattern"] = "phase";
        frame["axis"] = pattern.axis == Axis::row ? "row" : "column";
        frame["period_px"] = pattern.period_px;
        frame["step"] = pattern.step;
        frame["steps"] = pattern.steps;
        break;
    }
    capture["frames"].push_back(std::move(frame));
  }
  return capture;
}

Json settings_json(const RenderOptions& options) {
  Json settings{{"subject", options.subject},
                {"material", options.material},
                {"detail_mm", options.detail},
                {"subject_scale", options.subject_scale},
                {"pose_rotation_degrees", to_json(options.pose_rotation)},
                {"pose_translation_mm", to_json(options.pose_translation)},
                {"motion_mm_per_frame", to_json(options.motion)},
                {"rows", options.sequence.rows},
                {"columns", options.sequence.columns},
                {"inverses", options.sequence.inverses},
                {"patterns", options.sequence.phase ? "fast" : "thesis"},
                {"largest_incidence_degrees", largest_incidence_degrees}};
  settings.update(rig_and_camera_json(options));
  return settings;
}

Json scene_json(const Scene& scene, const RenderOptions& options) {
  const Facts& facts = scene.subject.facts;
  Json planes = Json::array();
  Json steps = Json::array();
  for (const PlaneFact& plane : facts.planes) {
    Json corners = Json::array();
    for (const Eigen::Vector3d& corner : plane.corners) corners.push_back(to_json(corner));
    Json entry{{"name", plane.name},
               {"point", to_json((plane.corners[0] + plane.corners[2]) / 2)},
               {"normal", to_json(plane.normal)},
               {"corners", std::move(corners)}};
    if (plane.height > 0) {
      entry["height_mm"] = plane.height;
      steps.push_back(std::move(entry));
    } else {
      planes.push_back(std::move(entry));
    }
  }
  Json spheres = Json::array();
  for (const SphereFact& sphere : facts.spheres)
    spheres.push_back({{"center", to_json(sphere.center)}, {"radius_mm", sphere.radius}});
  Json bumps = Json::array();
  for (const BumpFact& bump : facts.bumps)
    bumps.push_back({{"center", to_json(bump.center)},
                     {"normal", to_json(bump.normal)},
                     {"diameter_mm", bump.diameter},
                     {"height_mm", bump.height}});
  Json moles = Json::array();
  for (const MoleFact& mole : facts.moles)
    moles.push_back({{"center", to_json(mole.center)}, {"diameter_mm", mole.diameter}});
  return {{"format", "bodyscan-simulated-scene"},
          {"version", 1},
          {"subject", scene.subject.name},
          {"planes", std::move(planes)},
          {"steps", std::move(steps)},
          {"spheres", std::move(spheres)},
          {"bumps", std::move(bumps)},
          {"moles", std::move(moles)},
          {"settings", settings_json(options)}};
}

void append_number(std::string& text, double value, int digits) {
  std::array<char, 32> buffer;
  const auto result =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed, digits);
  text += ' ';
  text.append(buffer.data(), result.ptr);
}

Eigen::Vector3f vertex_albedo(const Scene& scene, std::size_t vertex) {
  const TriangleMesh& mesh = scene.subject.mesh;
  if (scene.subject.material == Material::skin)
    return skin_albedo(scene.subject_point(mesh.points[vertex]), scene.moles_in_subject);
  return mesh.albedo.empty() ? Eigen::Vector3f::Constant(matt_albedo) : mesh.albedo[vertex];
}

Expected<void> write_mesh(const fs::path& path, const Scene& scene) {
  const TriangleMesh& mesh = scene.subject.mesh;
  std::ofstream file(path, std::ios::binary);
  std::string text;
  const auto flush = [&](std::size_t least) {
    if (text.size() < least) return;
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
    text.clear();
  };
  constexpr std::size_t block = 1 << 20;
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    text += 'v';
    for (const double coordinate : mesh.points[i]) append_number(text, coordinate, 5);
    for (const float channel : vertex_albedo(scene, i))
      append_number(text, linear_to_srgb(static_cast<double>(channel)), 3);
    text += '\n';
    flush(block);
  }
  for (const Triangle& triangle : mesh.triangles) {
    text += 'f';
    for (const std::uint32_t corner : triangle) text += ' ' + std::to_string(corner + 1);
    text += '\n';
    flush(block);
  }
  flush(0);
  file.close();
  if (!file) return output_error(path.string() + ": cannot be written");
  return {};
}

Expected<void> write_truth(const fs::path& folder, const Truth& truth, const RenderOptions& options) {
  const TruthMaps& maps = truth.maps;
  return write_pfm(folder / "depth.pfm", maps.depth)
      .and_then([&] { return write_pfm(folder / "normal.pfm", maps.normal); })
      .and_then([&] { return write_pfm(folder / "rows.pfm", maps.rows); })
      .and_then([&] { return write_pfm(folder / "columns.pfm", maps.columns); })
      .and_then([&] { return write_png(folder / "reachable.png", maps.reachable); })
      .and_then([&] { return write_json(folder / "scene.json", scene_json(truth.scene, options)); })
      .and_then([&] {
        return options.write_mesh ? write_mesh(folder / "mesh.obj", truth.scene) : Expected<void>{};
      });
}

}  // namespace

Expected<void> write_capture(const fs::path& folder, const PatternSequence& sequence,
                             const Photograph& photograph, const RenderOptions& options) {
  std::mutex mutex;
  std::optional<Error> failure;
  parallel_for(0, static_cast<int>(sequence.patterns.size()), 1, [&](int index, int) {
    const ColorImage8 image = photograph(sequence.patterns[static_cast<std::size_t>(index)], index);
    const Expected<void> written = write_frame(folder / frame_name(index, options.format), image, options);
    const std::lock_guard lock(mutex);
    if (!written && !failure) failure = written.error();
  });
  if (failure) return tl::unexpected(*failure);
  return write_json(folder / "capture.json", capture_json(sequence, options.format));
}

Expected<Truth> render_capture(const RenderOptions& options) {
  if (options.output.empty()) return usage_error("--output: needs a folder");
  Expected<Scene> scene = make_scene(options);
  if (!scene) return tl::unexpected(scene.error());
  const Expected<PatternSequence> sequence =
      make_sequence(scene->calibration.projector.size, options.sequence);
  if (!sequence) return tl::unexpected(sequence.error());
  Truth truth{std::move(*scene), {}};
  Expected<void> written = make_folder(options.output / "truth").and_then([&] {
    return write_calibration(truth.scene.calibration, options.output / "calibration.yml");
  });
  if (!written) return tl::unexpected(written.error());
  Expected<Renderer> renderer = Renderer::make(truth.scene, options);
  if (!renderer) return tl::unexpected(renderer.error());
  written = write_capture(
      options.output, *sequence,
      [&](const Pattern& pattern, int index) { return renderer->frame(pattern, index); }, options);
  if (!written) return tl::unexpected(written.error());
  truth.maps = renderer->truth();
  written = write_truth(options.output / "truth", truth, options);
  if (!written) return tl::unexpected(written.error());
  return truth;
}

}  // namespace bodyscan::simulator
