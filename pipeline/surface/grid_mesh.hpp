#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/base/image.hpp"
#include "pipeline/geometry/point_grid.hpp"
#include "pipeline/model/mesh.hpp"
#include "pipeline/surface/cells.hpp"
#include "pipeline/surface/color.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace bodyscan {

// Takes one chunk after the other; an error ends the iteration and comes back from it.
template <class Item>
using ChunkSink = std::function<Expected<void>(std::span<const Item>)>;

// A triangle mesh on the camera's pixel grid. A byte a cell (cells.hpp) says which triangles exist; vertices
// are numbered in raster order, and only points that a triangle uses are vertices. Points, colours and faces
// exist a chunk at a time: a 12-megapixel scan has 11 million faces and they are never all in memory.
class GridMesh {
 public:
  GridMesh() = default;
  // `cells` has the grid's size; its last row and column are empty. Sets the cells' `used` bits.
  GridMesh(PointGrid grid, Image<std::uint8_t> cells);

  [[nodiscard]] Size size() const { return cells_.size(); }
  [[nodiscard]] std::size_t point_count() const { return point_begin_.empty() ? 0 : point_begin_.back(); }
  [[nodiscard]] std::size_t face_count() const { return face_begin_.empty() ? 0 : face_begin_.back(); }
  // All points that were measured; `has` says which are vertices.
  [[nodiscard]] const PointGrid& grid() const { return grid_; }
  [[nodiscard]] const Image<std::uint8_t>& cells() const { return cells_; }
  [[nodiscard]] bool has(int x, int y) const { return (cells_(x, y) & cell::used) != 0; }
  // Mean of sigma_mm over the vertices; 0 without any.
  [[nodiscard]] double mean_sigma_mm() const;

  // Vertices in raster order, mm in the camera frame.
  [[nodiscard]] Expected<void> for_each_points(const ChunkSink<Point3f>& sink) const;
  // The vertices' colours, in the same order. `colors` is of this mesh's size.
  [[nodiscard]] Expected<void> for_each_colors(const SurfaceColor& colors, const ChunkSink<Rgb8>& sink) const;
  // Faces, counter-clockwise seen from the camera.
  [[nodiscard]] Expected<void> for_each_faces(const ChunkSink<Face>& sink) const;

  // The whole mesh in memory, with colours where `colors` is not null.
  [[nodiscard]] Mesh to_mesh(const SurfaceColor* colors = nullptr) const;

 private:
  void number_rows();
  // Last of the rows from `first` on that hold about `items` items, as an end.
  [[nodiscard]] int chunk_end(int first, const std::vector<std::size_t>& begin, std::size_t items) const;
  void points_of_row(int y, Point3f* out) const;
  void faces_of_row(int y, Face* out) const;

  PointGrid grid_;
  Image<std::uint8_t> cells_;
  std::vector<std::size_t> point_begin_;  // number of a row's first vertex; one more than rows
  std::vector<std::size_t> face_begin_;
};

}  // namespace bodyscan
