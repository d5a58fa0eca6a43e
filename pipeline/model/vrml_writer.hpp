#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/model/background_output.hpp"
#include "pipeline/model/mesh.hpp"
#include "pipeline/model/model_info.hpp"
#include "pipeline/model/vrml_format.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace bodyscan {

enum class VrmlGeometry { face_set, point_cloud };

// Writes a VRML97 file piece by piece, in memory of 2 MiB a core.
//   points -> colors -> faces -> finished
// Each kind of piece may come in any number of calls, in this order; colours are left out or one a point, a
// face set has at least one face, a point cloud none. A call out of order, a point or face that cannot be
// written (vrml_format.hpp) and trouble with the file are errors of kind `output` that name the file; after
// an error the writer can only be destroyed. The file appears under its name when `finish` succeeds, else
// never.
class VrmlWriter {
 public:
  [[nodiscard]] static Expected<VrmlWriter> create(const std::filesystem::path& path, VrmlGeometry geometry,
                                                   const ModelInfo& info);

  // mm, camera frame (or world frame of a merged model). Spread over all cores when calls bring 50,000 or
  // more.
  [[nodiscard]] Expected<void> write_points(std::span<const Point3f> points);
  [[nodiscard]] Expected<void> write_colors(std::span<const Rgb8> colors);
  [[nodiscard]] Expected<void> write_faces(std::span<const Face> faces);
  [[nodiscard]] Expected<void> finish();

 private:
  enum class State { points, colors, faces, finished, failed };

  VrmlWriter(AtomicFile file, std::filesystem::path path, VrmlGeometry geometry, bool closed);
  [[nodiscard]] Expected<void> advance(State wanted);
  [[nodiscard]] Expected<void> write_text(std::string_view text);
  [[nodiscard]] Expected<void> fail(const std::string& reason);
  template <class Item, class Format>
  [[nodiscard]] Expected<void> write_items(std::span<const Item> items, std::size_t item_bytes,
                                           std::size_t& written, std::string_view name,
                                           std::string_view trouble, Format format);

  std::filesystem::path path_;
  VrmlGeometry geometry_;
  bool closed_;
  State state_ = State::points;
  std::size_t points_ = 0;
  std::size_t colors_ = 0;
  std::size_t faces_ = 0;
  std::unique_ptr<BackgroundOutput> output_;
};

// The whole mesh as a face set, or as a point cloud if it has no faces.
[[nodiscard]] Expected<void> write_model(const std::filesystem::path& path, const Mesh& mesh,
                                         const ModelInfo& info);

}  // namespace bodyscan
