#include "pipeline/model/vrml_reader.hpp"

#include "pipeline/model/vrml_scanner.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace bodyscan {
namespace {

using vrml::Scanner;

// Recursive descent over nodes; false means that the scanner holds the error.
class Parser {
 public:
  Parser(vrml::Source source, const VrmlLimits& limits) : scan_(std::move(source)), limits_(limits) {}

  Expected<VrmlModel> run() {
    if (!file() || scan_.error()) return tl::unexpected(*scan_.error());
    return std::move(model_);
  }

 private:
  bool file() {
    if (!scan_.header()) return false;
    while (!scan_.at_end()) {
      std::string name;
      if (!scan_.word(name)) return false;
      if (name == "ROUTE" ? !skip_words(3) : !scene_node(std::move(name))) return false;
    }
    return found_geometry_ || scan_.fail("no IndexedFaceSet and no PointSet");
  }

  bool enter() {
    if (++depth_ <= limits_.nesting) return true;
    return scan_.fail("nested deeper than " + std::to_string(limits_.nesting) + " levels");
  }

  // The fields of a node, braces included.
  template <class Field>
  bool body(Field field) {
    if (!scan_.expect('{') || !enter()) return false;
    while (!scan_.accept('}')) {
      std::string name;
      if (!scan_.word(name)) return false;
      if (name == "ROUTE" ? !skip_words(3) : !field(name)) return false;
    }
    --depth_;
    return true;
  }

  bool skip_words(int count) {
    std::string ignored;
    for (; count > 0; --count) {
      if (!scan_.word(ignored)) return false;
    }
    return true;
  }

  // What stands before the brace of a node; `type` comes in as the word already read.
  bool node_type(std::string& type) {
    if (type == "DEF" && !(skip_words(1) && scan_.word(type))) return false;
    if (type == "USE" || type == "PROTO" || type == "EXTERNPROTO") {
      return scan_.fail(type + " is not supported");
    }
    return true;
  }

  // One bracket or brace and all in it.
  bool skip_balanced() {
    std::string open;
    do {
      const char next = scan_.peek();
      if (next == '{' || next == '[') {
        if (!scan_.expect(next) || !enter()) return false;
        open += next;
      } else if (next == '}' || next == ']') {
        if (!scan_.expect(open.back() == '{' ? '}' : ']')) return false;
        open.pop_back();
        --depth_;
      } else if (next == '"') {
        if (!scan_.string(text_, limits_.string_bytes)) return false;
      } else if (!scan_.skip_token()) {
        return false;
      }
    } while (!open.empty());
    return true;
  }

  bool skip_node() { return scan_.peek() == '{' ? skip_balanced() : scan_.expect('{'); }

  // The value of a field of unknown type (ISO/IEC 14772-1, A.3).
  bool skip_value() {
    const auto is_number = [](char c) { return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.'; };
    char next = scan_.peek();
    if (next == '[') return skip_balanced();
    if (next == '"') return scan_.string(text_, limits_.string_bytes);
    if (is_number(next)) {
      for (; is_number(next); next = scan_.peek()) {
        if (!scan_.skip_token()) return false;
      }
      return true;
    }
    std::string word;
    if (!scan_.word(word)) return false;
    if (word == "TRUE" || word == "FALSE" || word == "NULL") return true;
    if (word == "USE" || word == "IS") return skip_words(1);
    return node_type(word) && skip_node();
  }

  bool boolean(bool& value) {
    std::string word;
    if (!scan_.word(word)) return false;
    value = word == "TRUE";
    return value || word == "FALSE" || scan_.fail(word + " where TRUE or FALSE is due");
  }

  bool scene_node(std::string type) {
    if (type == "NULL") return true;
    if (!node_type(type)) return false;
    if (type == "Transform" || type == "Group") {
      return body(
          [this](const std::string& field) { return field == "children" ? children() : skip_value(); });
    }
    if (type == "Shape") {
      return body(
          [this](const std::string& field) { return field == "geometry" ? geometry() : skip_value(); });
    }
    if (type == "WorldInfo") {
      return body([this](const std::string& field) { return field == "info" ? info() : skip_value(); });
    }
    return skip_node();
  }

  bool children() {
    std::string type;
    if (!scan_.accept('[')) return scan_.word(type) && scene_node(std::move(type));
    if (!enter()) return false;
    while (!scan_.accept(']')) {
      if (!scan_.word(type) || !scene_node(std::move(type))) return false;
    }
    --depth_;
    return true;
  }

  bool info() {
    if (!scan_.accept('[')) return info_line();
    while (!scan_.accept(']')) {
      if (!info_line()) return false;
    }
    return true;
  }

  bool info_line() {
    if (!scan_.string(text_, limits_.string_bytes)) return false;
    const auto take = [this](std::string_view key, std::string& value) {
      if (text_.starts_with(key)) value = text_.substr(key.size());
    };
    take("calibration: ", model_.info.calibration);
    take("software: ", model_.info.software);
    take("comment: ", model_.info.comment);
    return true;
  }

  bool geometry() {
    std::string type;
    if (!scan_.word(type)) return false;
    if (type == "NULL") return true;
    if (!node_type(type)) return false;
    if (type != "IndexedFaceSet" && type != "PointSet") return skip_node();
    if (std::exchange(found_geometry_, true)) return scan_.fail("a second geometry");
    const bool faces = type == "IndexedFaceSet";
    model_.info.closed = faces;  // the default of `solid`
    return body([&](const std::string& field) { return geometry_field(field, faces); }) && check(faces);
  }

  bool geometry_field(const std::string& field, bool faces) {
    if (field == "coord") return array_node("Coordinate", "point", [this] { return points(); });
    if (field == "color") return array_node("Color", "color", [this] { return colors(); });
    if (!faces) return skip_value();
    if (field == "coordIndex") return polygons();
    if (field == "colorIndex") {
      return scan_.expect('[') && (scan_.accept(']') || scan_.fail("colorIndex is not supported"));
    }
    if (field == "colorPerVertex") return boolean(color_per_vertex_);
    if (field == "solid") return boolean(model_.info.closed);
    if (field == "ccw") return boolean(ccw_);
    if (field == "convex") return boolean(convex_);
    return skip_value();
  }

  template <class Array>
  bool array_node(std::string_view wanted, std::string_view array_name, Array array) {
    std::string type;
    if (!scan_.word(type)) return false;
    if (type == "NULL") return true;
    if (!node_type(type)) return false;
    if (type != wanted) return scan_.fail(type + " where " + std::string(wanted) + " is due");
    return body([&](const std::string& field) { return field == array_name ? array() : skip_value(); });
  }

  bool points() {
    auto& points = model_.mesh.points;
    if (!points.empty()) return scan_.fail("points a second time");
    if (!scan_.expect('[')) return false;
    while (!scan_.accept(']')) {
      Point3f point;
      if (!scan_.number(point.x) || !scan_.number(point.y) || !scan_.number(point.z)) return false;
      if (points.size() == limits_.points) {
        return scan_.fail("more than " + std::to_string(limits_.points) + " points");
      }
      points.push_back(point);
    }
    return true;
  }

  bool colors() {
    auto& colors = model_.mesh.colors;
    if (!colors.empty()) return scan_.fail("colors a second time");
    if (!scan_.expect('[')) return false;
    while (!scan_.accept(']')) {
      Rgb8 color;
      for (std::uint8_t& component : color) {
        float value = 0;
        if (!scan_.number(value)) return false;
        if (!(value >= 0 && value <= 1)) return scan_.fail("a color outside 0 to 1");
        component = static_cast<std::uint8_t>(std::floor(value * 255 + 0.5F));
      }
      if (colors.size() == limits_.points) {
        return scan_.fail("more than " + std::to_string(limits_.points) + " colors");
      }
      colors.push_back(color);
    }
    return true;
  }

  bool polygons() {
    if (!model_.mesh.faces.empty()) return scan_.fail("coordIndex a second time");
    if (!scan_.expect('[')) return false;
    while (!scan_.accept(']')) {
      if (!polygon()) return false;
    }
    return true;
  }

  bool polygon() {
    std::uint32_t first = 0;
    std::uint32_t previous = 0;
    std::size_t corners = 0;
    for (std::uint32_t corner = 0;; previous = corner, ++corners) {
      std::int32_t index = 0;
      if (scan_.peek() == ']') return scan_.fail("coordIndex does not end with -1");
      if (!scan_.integer(index)) return false;
      if (index == -1) break;
      if (index < 0) return scan_.fail("index " + std::to_string(index));
      corner = static_cast<std::uint32_t>(index);
      if (corner > max_index_) {
        max_index_ = corner;
        max_index_line_ = scan_.line();
      }
      if (corners == 0) first = corner;
      if (corners >= 1 && (corner == previous || (corners >= 2 && corner == first))) {
        return scan_.fail("a face with point " + std::to_string(corner) + " twice");
      }
      if (corners >= 2 && !add_face({first, previous, corner})) return false;
    }
    has_polygons_ |= corners > 3;
    return corners >= 3 || scan_.fail("a face of fewer than three points");
  }

  bool add_face(const Face& face) {
    if (model_.mesh.faces.size() == limits_.faces) {
      return scan_.fail("more than " + std::to_string(limits_.faces) + " faces");
    }
    model_.mesh.faces.push_back(face);
    return true;
  }

  // What can be told only when a geometry is complete, since its fields come in any order.
  bool check(bool face_set) {
    Mesh& mesh = model_.mesh;
    if (mesh.points.empty()) return scan_.fail("a geometry without points");
    if (face_set && mesh.faces.empty()) return scan_.fail("an IndexedFaceSet without faces");
    if (face_set && max_index_ >= mesh.points.size()) {
      return scan_.fail_in(max_index_line_, "index " + std::to_string(max_index_) + " of " +
                                                std::to_string(mesh.points.size()) + " points");
    }
    if (!mesh.colors.empty() && mesh.colors.size() != mesh.points.size()) {
      return scan_.fail(std::to_string(mesh.colors.size()) + " colors for " +
                        std::to_string(mesh.points.size()) + " points");
    }
    if (!mesh.colors.empty() && !color_per_vertex_) return scan_.fail("colors that are not one a point");
    if (has_polygons_ && !convex_) return scan_.fail("polygons that are not convex");
    if (!ccw_) {
      for (Face& face : mesh.faces) std::swap(face[1], face[2]);
    }
    return true;
  }

  Scanner scan_;
  const VrmlLimits& limits_;
  VrmlModel model_;
  std::string text_;
  int depth_ = 0;
  bool found_geometry_ = false;
  bool color_per_vertex_ = true;
  bool ccw_ = true;
  bool convex_ = true;
  bool has_polygons_ = false;
  std::uint32_t max_index_ = 0;
  std::size_t max_index_line_ = 0;
};

tl::unexpected<Error> too_large(const VrmlLimits& limits) {
  return input_error("larger than " + std::to_string(limits.file_bytes) + " bytes");
}

}  // namespace

Expected<VrmlModel> parse_model(std::string_view text, const VrmlLimits& limits) {
  if (text.size() > limits.file_bytes) return too_large(limits);
  const auto source = [&text](std::span<char> buffer) -> Expected<std::size_t> {
    const std::size_t count = std::min(buffer.size(), text.size());
    std::memcpy(buffer.data(), text.data(), count);
    text.remove_prefix(count);
    return count;
  };
  return Parser(source, limits).run();
}

Expected<VrmlModel> read_model(const std::filesystem::path& path, const VrmlLimits& limits) {
  const auto close = [](std::FILE* file) { std::fclose(file); };
  const std::unique_ptr<std::FILE, decltype(close)> file(std::fopen(path.c_str(), "rbe"), close);
  const auto reason = [](int code) { return std::generic_category().message(code); };
  if (!file) return input_error(path.string() + ": cannot open: " + reason(errno));
  std::setvbuf(file.get(), nullptr, _IONBF, 0);
  std::uint64_t total = 0;
  const auto source = [&](std::span<char> buffer) -> Expected<std::size_t> {
    const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), file.get());
    if (count < buffer.size() && std::ferror(file.get()) != 0) {
      return input_error("cannot read: " + reason(errno));
    }
    total += count;
    if (total > limits.file_bytes) return too_large(limits);
    return count;
  };
  Expected<VrmlModel> model = Parser(source, limits).run();
  if (!model) return tl::unexpected(model.error().within(path.string()));
  return model;
}

}  // namespace bodyscan
