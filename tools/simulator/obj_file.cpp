#include "tools/simulator/obj_file.hpp"

#include "tools/simulator/image_files.hpp"
#include "tools/simulator/sensor.hpp"

#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

namespace bodyscan::simulator {
namespace {

constexpr std::size_t max_faces = std::size_t{1} << 26;

Expected<std::string> read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf())) return input_error(path.string() + ": cannot be read");
  return std::move(text).str();
}

std::string_view next_word(std::string_view& line) {
  const std::size_t begin = line.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return line = {};
  const std::size_t end = std::min(line.find_first_of(" \t\r", begin), line.size());
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

std::string trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return std::string(text.substr(begin, text.find_last_not_of(" \t\r") + 1 - begin));
}

template <class Number>
std::optional<Number> to_number(std::string_view word) {
  Number value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return value;
}

// The remaining numbers of a line; nothing if one is no finite number.
std::optional<std::vector<double>> numbers(std::string_view line) {
  std::vector<double> values;
  for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
    const auto value = to_number<double>(word);
    if (!value || !std::isfinite(*value)) return std::nullopt;
    values.push_back(*value);
  }
  return values;
}

struct ObjMaterial {
  long number = -1;  // in the order of the files
  std::optional<Eigen::Vector3f> albedo;
  std::int32_t texture = -1;
};

class ObjReader {
 public:
  explicit ObjReader(std::filesystem::path path) : path_(std::move(path)) {}

  Expected<Subject> read() {
    const Expected<std::string> text = read_text(path_);
    if (!text) return tl::unexpected(text.error());
    int line_number = 0;
    for (std::size_t begin = 0; begin < text->size();) {
      const std::size_t end = std::min(text->find('\n', begin), text->size());
      ++line_number;
      const std::string problem = statement(std::string_view(*text).substr(begin, end - begin));
      if (!problem.empty())
        return input_error(path_.string() + ": line " + std::to_string(line_number) + ": " + problem);
      begin = end + 1;
    }
    return finish();
  }

 private:
  using Corner = std::array<long, 3>;  // indices of point, texture coordinate and normal, -1 for none

  // Empty, or what is wrong.
  std::string statement(std::string_view line) {
    const std::string_view keyword = next_word(line);
    if (keyword == "f") return face(line);
    if (keyword == "mtllib") return materials(trimmed(line));
    if (keyword == "usemtl") {
      const auto found = materials_.find(trimmed(line));
      material_ = found == materials_.end() ? ObjMaterial{} : found->second;
      return {};
    }
    if (keyword != "v" && keyword != "vt" && keyword != "vn") return {};
    const auto values = numbers(line);
    if (!values) return "not a finite number";
    const std::size_t least = keyword == "vt" ? 2 : 3;
    if (values->size() < least) return "too few numbers";
    const std::vector<double>& n = *values;
    // The file's y points up and its z towards the viewer.
    if (keyword == "v") {
      points_.emplace_back(n[0], -n[1], -n[2]);
      if (n.size() >= 6) colors_.resize(points_.size(), Eigen::Vector3f::Constant(0.82F));
      if (n.size() >= 6)
        colors_.back() = Eigen::Vector3d(n[3], n[4], n[5]).unaryExpr(&srgb_to_linear).cast<float>();
    } else if (keyword == "vt") {
      texture_at_.emplace_back(static_cast<float>(n[0]), static_cast<float>(n[1]));
    } else {
      normals_.emplace_back(Eigen::Vector3d(n[0], -n[1], -n[2]).stableNormalized().cast<float>());
    }
    return {};
  }

  std::string materials(const std::string& name) {
    const std::filesystem::path file = path_.parent_path() / name;
    std::error_code problem;
    if (!std::filesystem::exists(file, problem)) return {};
    const Expected<std::string> text = read_text(file);
    if (!text) return text.error().message;
    std::string current;
    for (std::size_t begin = 0; begin < text->size();) {
      const std::size_t end = std::min(text->find('\n', begin), text->size());
      std::string_view line = std::string_view(*text).substr(begin, end - begin);
      begin = end + 1;
      const std::string_view keyword = next_word(line);
      if (keyword == "newmtl") {
        const auto number = static_cast<long>(materials_.size());
        materials_[current = trimmed(line)] = {.number = number, .albedo = {}, .texture = -1};
      } else if (keyword == "Kd") {
        const auto values = numbers(line);
        if (!values || values->size() < 3) return name + ": Kd needs three numbers";
        materials_[current].albedo = Eigen::Vector3d((*values)[0], (*values)[1], (*values)[2])
                                         .unaryExpr(&srgb_to_linear)
                                         .cast<float>();
      } else if (keyword == "map_Kd") {
        Expected<ColorImage8> texture = read_color_image(file.parent_path() / trimmed(line));
        if (!texture) return texture.error().message;
        materials_[current].texture = static_cast<std::int32_t>(mesh_.textures.size());
        mesh_.textures.push_back(std::move(*texture));
      }
    }
    return {};
  }

  // An index as the file has it (from 1, or negative from the end) to one from 0; nothing if there is no
  // such.
  static std::optional<long> resolve(std::string_view word, std::size_t count) {
    const auto index = to_number<long>(word);
    if (!index) return std::nullopt;
    const long resolved = *index < 0 ? static_cast<long>(count) + *index : *index - 1;
    if (resolved < 0 || resolved >= static_cast<long>(count)) return std::nullopt;
    return resolved;
  }

  std::string face(std::string_view line) {
    std::vector<std::uint32_t> corners;
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
      Corner corner{-1, -1, -1};
      const std::array<std::size_t, 3> counts{points_.size(), texture_at_.size(), normals_.size()};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t slash = std::min(word.find('/'), word.size());
        const std::string_view part = word.substr(0, slash);
        word.remove_prefix(std::min(slash + 1, word.size()));
        if (part.empty()) continue;
        const auto index = resolve(part, counts[k]);
        if (!index) return "no such index: " + std::string(part);
        corner[k] = *index;
      }
      if (corner[0] < 0) return "a corner without a point";
      corners.push_back(vertex(corner));
    }
    if (corners.size() < 3) return "a face of fewer than three corners";
    if (mesh_.triangles.size() + corners.size() > max_faces) return "too many faces";
    for (std::size_t i = 2; i < corners.size(); ++i) {
      mesh_.triangles.push_back({corners[0], corners[i - 1], corners[i]});
      mesh_.textures_of.push_back(material_.texture);
    }
    return {};
  }

  std::uint32_t vertex(const Corner& corner) {
    const auto next = static_cast<std::uint32_t>(mesh_.points.size());
    const auto [entry, fresh] =
        vertices_.try_emplace({corner[0], corner[1], corner[2], material_.number}, next);
    if (!fresh) return entry->second;
    mesh_.points.push_back(points_[static_cast<std::size_t>(corner[0])]);
    mesh_.texture_at.push_back(corner[1] < 0 ? Eigen::Vector2f(0, 0)
                                             : texture_at_[static_cast<std::size_t>(corner[1])]);
    // A zero normal stands for the triangle's own.
    mesh_.normals.emplace_back(corner[2] < 0 ? Eigen::Vector3f(0, 0, 0)
                                             : normals_[static_cast<std::size_t>(corner[2])]);
    colors_.resize(points_.size(), Eigen::Vector3f::Constant(0.82F));
    mesh_.albedo.push_back(material_.albedo.value_or(colors_[static_cast<std::size_t>(corner[0])]));
    return next;
  }

  Expected<Subject> finish() {
    if (mesh_.triangles.empty()) return input_error(path_.string() + ": holds no faces");
    Eigen::Vector3d smallest = mesh_.points.front();
    Eigen::Vector3d largest = smallest;
    for (const Eigen::Vector3d& point : mesh_.points) {
      smallest = smallest.cwiseMin(point);
      largest = largest.cwiseMax(point);
    }
    for (Eigen::Vector3d& point : mesh_.points) point -= (smallest + largest) / 2;
    return Subject{
        .name = path_.filename().string(), .mesh = std::move(mesh_), .facts = {}, .material = Material::matt};
  }

  std::filesystem::path path_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<Eigen::Vector3f> colors_;
  std::vector<Eigen::Vector2f> texture_at_;
  std::vector<Eigen::Vector3f> normals_;
  std::map<std::string, ObjMaterial> materials_;
  ObjMaterial material_;
  std::map<std::array<long, 4>, std::uint32_t> vertices_;
  TriangleMesh mesh_;
};

}  // namespace

Expected<Subject> read_obj(const std::filesystem::path& path) {
  return ObjReader(path).read();
}

}  // namespace bodyscan::simulator
