#include "pipeline/model/vrml_writer.hpp"

#include "pipeline/base/parallel.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

namespace bodyscan {
namespace {

constexpr std::array<std::string_view, 5> state_names = {"points", "colors", "faces", "finished", "failed"};

constexpr std::size_t max_text_bytes = 65000;  // below VrmlLimits::string_bytes

// Blocks for one batch being formatted while the one before is written.
std::size_t batch_blocks() {
  return static_cast<std::size_t>(thread_count());
}

std::string head(VrmlGeometry geometry, const ModelInfo& info) {
  const bool faces = geometry == VrmlGeometry::face_set;
  std::string text = "#VRML V2.0 utf8\nWorldInfo {\n  title \"bodyscan model\"\n  info [\n";
  text += "    \"unit: points in millimetres, the Transform makes metres of them\"\n";
  text += "    " + vrml::quoted("calibration: " + info.calibration) + "\n";
  text += "    " + vrml::quoted("software: " + info.software) + "\n";
  text += "    " + vrml::quoted("comment: " + info.comment) + "\n  ]\n}\n";
  text += "Transform {\n  rotation 1 0 0 3.14159265\n  scale 0.001 0.001 0.001\n  children Shape {\n";
  // Points are not lit: without colours of their own they have the material's emissive colour.
  text += faces ? "    appearance Appearance { material Material { } }\n    geometry IndexedFaceSet {\n"
                : "    appearance Appearance { material Material { emissiveColor 1 1 1 } }\n"
                  "    geometry PointSet {\n";
  return text + "coord Coordinate { point [\n";
}

}  // namespace

VrmlWriter::VrmlWriter(AtomicFile file, std::filesystem::path path, VrmlGeometry geometry, bool closed)
    : path_(std::move(path)),
      geometry_(geometry),
      closed_(closed),
      output_(std::make_unique<BackgroundOutput>(std::move(file), 2 * batch_blocks())) {}

Expected<VrmlWriter> VrmlWriter::create(const std::filesystem::path& path, VrmlGeometry geometry,
                                        const ModelInfo& info) {
  Expected<AtomicFile> file = AtomicFile::create(path);
  if (!file) return tl::unexpected(file.error());
  for (const auto& [name, text] :
       {std::pair("calibration", &info.calibration), std::pair("software version", &info.software),
        std::pair("comment", &info.comment)}) {
    if (text->size() > max_text_bytes) {
      return output_error(path.string() + ": a " + name + " of more than " + std::to_string(max_text_bytes) +
                          " bytes");
    }
  }
  VrmlWriter writer(std::move(*file), path, geometry, info.closed);
  if (Expected<void> written = writer.write_text(head(geometry, info)); !written) {
    return tl::unexpected(written.error());
  }
  return writer;
}

Expected<void> VrmlWriter::fail(const std::string& reason) {
  state_ = State::failed;
  output_.reset();
  return output_error(path_.string() + ": " + reason);
}

Expected<void> VrmlWriter::write_text(std::string_view text) {
  for (; !text.empty(); text.remove_prefix(std::min(text.size(), BackgroundOutput::block_bytes))) {
    BackgroundOutput::Block block = output_->take();
    block.size = std::min(text.size(), BackgroundOutput::block_bytes);
    std::memcpy(block.bytes.get(), text.data(), block.size);
    if (Expected<void> put = output_->put(std::move(block)); !put) {
      state_ = State::failed;
      return put;
    }
  }
  return {};
}

// Goes on to `wanted`, writing the lines between the states passed.
Expected<void> VrmlWriter::advance(State wanted) {
  if (state_ > wanted || state_ == State::finished) {
    return fail("cannot write " + std::string(state_names[static_cast<std::size_t>(wanted)]) + " in state " +
                std::string(state_names[static_cast<std::size_t>(state_)]));
  }
  if (wanted >= State::faces && state_ < State::faces) {
    if (points_ == 0) return fail("a model without points");
    if (colors_ != 0 && colors_ != points_) {
      return fail(std::to_string(colors_) + " colors for " + std::to_string(points_) + " points");
    }
  }
  std::string text;
  if (state_ == State::points && wanted >= State::colors) text += "] }\n";
  if (state_ == State::points && wanted == State::colors) text += "color Color { color [\n";
  if (state_ == State::colors && wanted >= State::faces) text += "] }\n";
  if (wanted == State::faces && state_ != State::faces) {
    if (geometry_ != VrmlGeometry::face_set) return fail("faces in a point cloud");
    text += "colorPerVertex TRUE\nsolid ";
    text += closed_ ? "TRUE" : "FALSE";
    text += "\ncoordIndex [\n";
  }
  if (wanted == State::finished) {
    if (geometry_ == VrmlGeometry::face_set && faces_ == 0) return fail("a face set without faces");
    text += state_ == State::faces ? "]\n    }\n  }\n}\n" : "    }\n  }\n}\n";
  }
  state_ = wanted;
  return write_text(text);
}

template <class Item, class Format>
Expected<void> VrmlWriter::write_items(std::span<const Item> items, std::size_t item_bytes,
                                       std::size_t& written, std::string_view name, std::string_view trouble,
                                       Format format) {
  const std::size_t block_items = BackgroundOutput::block_bytes / item_bytes;
  std::vector<BackgroundOutput::Block> blocks(batch_blocks());
  while (!items.empty()) {
    const std::size_t count = std::min(blocks.size(), (items.size() + block_items - 1) / block_items);
    std::vector<std::size_t> formatted(count);
    for (std::size_t i = 0; i < count; ++i) blocks[i] = output_->take();
    parallel_for(0, static_cast<int>(count), 1, [&](int begin, int end) {
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
        const std::size_t first = i * block_items;
        const auto part = items.subspan(first, std::min(block_items, items.size() - first));
        const vrml::Formatted result = format(part, blocks[i].bytes.get());
        formatted[i] = result.items;
        blocks[i].size = result.bytes;
      }
    });
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t expected = std::min(block_items, items.size());
      written += formatted[i];
      if (formatted[i] != expected) {
        return fail(std::string(name) + " " + std::to_string(written) + ": " + std::string(trouble));
      }
      if (Expected<void> put = output_->put(std::move(blocks[i])); !put) {
        state_ = State::failed;
        return put;
      }
      items = items.subspan(expected);
    }
  }
  return {};
}

Expected<void> VrmlWriter::write_points(std::span<const Point3f> points) {
  if (Expected<void> ready = advance(State::points); !ready) return ready;
  if (points.size() > std::numeric_limits<std::int32_t>::max() - points_) return fail("too many points");
  return write_items(points, vrml::max_point_bytes, points_, "point", "not finite or farther away than 100 m",
                     [](std::span<const Point3f> part, char* out) { return vrml::format_points(part, out); });
}

Expected<void> VrmlWriter::write_colors(std::span<const Rgb8> colors) {
  if (colors.empty() && state_ == State::points) return {};
  if (Expected<void> ready = advance(State::colors); !ready) return ready;
  return write_items(colors, vrml::max_color_bytes, colors_, "color", "",
                     [](std::span<const Rgb8> part, char* out) { return vrml::format_colors(part, out); });
}

Expected<void> VrmlWriter::write_faces(std::span<const Face> faces) {
  if (Expected<void> ready = advance(State::faces); !ready) return ready;
  const auto point_count = static_cast<std::uint32_t>(points_);
  return write_items(faces, vrml::max_face_bytes, faces_, "face",
                     "an index without a point, or the same one twice",
                     [point_count](std::span<const Face> part, char* out) {
                       return vrml::format_faces(part, point_count, out);
                     });
}

Expected<void> VrmlWriter::finish() {
  if (Expected<void> ready = advance(State::finished); !ready) return ready;
  return output_->finish(Durability::process);
}

Expected<void> write_model(const std::filesystem::path& path, const Mesh& mesh, const ModelInfo& info) {
  const VrmlGeometry geometry = mesh.faces.empty() ? VrmlGeometry::point_cloud : VrmlGeometry::face_set;
  Expected<VrmlWriter> writer = VrmlWriter::create(path, geometry, info);
  if (!writer) return tl::unexpected(writer.error());
  Expected<void> result = writer->write_points(mesh.points);
  if (result && !mesh.colors.empty()) result = writer->write_colors(mesh.colors);
  if (result && !mesh.faces.empty()) result = writer->write_faces(mesh.faces);
  return result ? writer->finish() : result;
}

}  // namespace bodyscan
