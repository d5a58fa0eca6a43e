#include "tools/evaluate/truth.hpp"

#include "pipeline/base/parallel.hpp"
#include "pipeline/base/read_file.hpp"
#include "pipeline/calibration/calibration_file.hpp"
#include "pipeline/image/codec.hpp"
#include "tools/evaluate/pfm.hpp"

#include <array>
#include <charconv>
#include <utility>

#include <nlohmann/json.hpp>

namespace bodyscan {
namespace {

using Eigen::Vector3d;
using nlohmann::json;

constexpr std::size_t max_text_bytes = std::size_t{4} << 30;

Vector3d vector_of(const json& value) {
  const auto numbers = value.get<std::array<double, 3>>();
  return {numbers[0], numbers[1], numbers[2]};
}

NamedPlane plane_of(const json& value) {
  const Vector3d normal = vector_of(value.at("normal")).normalized();
  return {value.at("name"), {normal, normal.dot(vector_of(value.at("point")))}};
}

SceneFacts facts_of(const json& scene) {
  SceneFacts facts;
  for (const json& plane : scene.at("planes")) facts.planes.push_back(plane_of(plane));
  for (const json& step : scene.at("steps")) facts.steps.push_back(plane_of(step));
  for (const json& sphere : scene.at("spheres")) {
    facts.spheres.push_back({vector_of(sphere.at("center")), sphere.at("radius_mm")});
  }
  for (const json& bump : scene.at("bumps")) {
    facts.bumps.push_back({vector_of(bump.at("center")), bump.at("diameter_mm"), bump.at("height_mm")});
  }
  for (const json& mole : scene.at("moles")) {
    facts.moles.push_back({vector_of(mole.at("center")), mole.at("diameter_mm")});
  }
  return facts;
}

Expected<SceneFacts> read_facts(const std::filesystem::path& file) {
  const Expected<std::vector<std::byte>> bytes = read_file(file, max_text_bytes);
  if (!bytes) return tl::unexpected(bytes.error());
  try {
    return facts_of(json::parse(as_text(*bytes)));
  } catch (const json::exception& error) {
    return input_error(file.string() + ": " + error.what());
  }
}

// The `v` and `f` lines of an OBJ file of triangles; everything else is passed over.
class ObjScanner {
 public:
  explicit ObjScanner(std::string_view text) : at_(text.data()), end_(text.data() + text.size()) {}

  bool next_line() {
    while (at_ != end_ && *at_ != '\n') ++at_;
    if (at_ != end_) ++at_;
    return at_ != end_;
  }
  bool starts_with(char letter) {
    if (end_ - at_ < 2 || at_[0] != letter || at_[1] != ' ') return false;
    at_ += 2;
    return true;
  }
  template <class Number>
  bool number(Number& value) {
    while (at_ != end_ && *at_ == ' ') ++at_;
    const auto [rest, problem] = std::from_chars(at_, end_, value);
    if (problem != std::errc()) return false;
    at_ = rest;
    return true;
  }
  void skip_word() {
    while (at_ != end_ && *at_ != ' ' && *at_ != '\n') ++at_;
  }

 private:
  const char* at_;
  const char* end_;
};

Expected<Mesh> read_obj(const std::filesystem::path& file) {
  const Expected<std::vector<std::byte>> bytes = read_file(file, max_text_bytes);
  if (!bytes) return tl::unexpected(bytes.error());
  Mesh mesh;
  ObjScanner scanner(as_text(*bytes));
  std::size_t line = 1;
  do {
    bool well = true;
    if (scanner.starts_with('v')) {
      Point3f point;
      well = scanner.number(point.x) && scanner.number(point.y) && scanner.number(point.z);
      mesh.points.push_back(point);
    } else if (scanner.starts_with('f')) {
      Face face{};
      for (std::uint32_t& index : face) {
        well = well && scanner.number(index) && index >= 1 && index <= mesh.points.size();
        --index;
        scanner.skip_word();
      }
      mesh.faces.push_back(face);
    }
    if (!well) return input_error(file.string() + ":" + std::to_string(line) + ": not a vertex or triangle");
    ++line;
  } while (scanner.next_line());
  return mesh;
}

Expected<GrayImage8> read_mask(const std::filesystem::path& file) {
  const Expected<std::vector<std::byte>> bytes = read_file(file, ImageLimits{}.max_file_bytes);
  if (!bytes) return tl::unexpected(bytes.error());
  Expected<Luma> luma = decode_luma(*bytes);
  if (!luma) return tl::unexpected(luma.error().within(file.string()));
  if (auto* mask = std::get_if<GrayImage8>(&*luma)) return std::move(*mask);
  return input_error(file.string() + ": not 8 bits deep");
}

}  // namespace

void place_points(Truth& truth) {
  truth.points = Image<Point3f>(truth.depth.size());
  parallel_for(0, truth.depth.height(), 8, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      for (int x = 0; x < truth.depth.width(); ++x) {
        const double depth = truth.has(x, y) ? truth.depth(x, y) : 0;
        const Eigen::Vector3f place = (truth.calibration.camera.ray({x, y}) * depth).cast<float>();
        truth.points(x, y) = {place.x(), place.y(), place.z()};
      }
    }
  });
}

Expected<Truth> read_truth(const std::filesystem::path& capture_dir) {
  const std::filesystem::path folder = capture_dir / "truth";
  Expected<Calibration> calibration = read_calibration(capture_dir / "calibration.yml");
  if (!calibration) return tl::unexpected(calibration.error());
  Expected<FloatImage> depth = read_pfm(folder / "depth.pfm");
  if (!depth) return tl::unexpected(depth.error());
  Expected<Image<Point3f>> normals = read_pfm_vectors(folder / "normal.pfm");
  if (!normals) return tl::unexpected(normals.error());
  Expected<GrayImage8> reachable = read_mask(folder / "reachable.png");
  if (!reachable) return tl::unexpected(reachable.error());
  const Size size = calibration->camera.size;
  if (depth->size() != size || normals->size() != size || reachable->size() != size) {
    return input_error(folder.string() + ": the maps are not of the camera's size");
  }
  Expected<SceneFacts> facts = read_facts(folder / "scene.json");
  if (!facts) return tl::unexpected(facts.error());
  Expected<Mesh> mesh = read_obj(folder / "mesh.obj");
  if (!mesh) return tl::unexpected(mesh.error());
  Expected<TrueSurface> surface = TrueSurface::build(std::move(*mesh));
  if (!surface) return tl::unexpected(surface.error().within((folder / "mesh.obj").string()));

  Truth truth{std::move(*calibration), std::move(*depth), std::move(*normals), std::move(*reachable), {},
              std::move(*surface),     std::move(*facts)};
  place_points(truth);
  return truth;
}

}  // namespace bodyscan
