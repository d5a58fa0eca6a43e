#include "pipeline/surface/simplify.hpp"

#include "pipeline/base/parallel.hpp"
#include "pipeline/surface/triangle_fit.hpp"

#include <array>
#include <cstdlib>
#include <utility>
#include <vector>

namespace bodyscan {
namespace {

// The hierarchy. Tiles of `tile` pixels are cut along a diagonal into two right triangles; a triangle is
// split from its right angle to the middle of its hypotenuse, again and again, down to halves of cells. The
// middle of a diagonal is the centre of a square; the middle of an upright or level hypotenuse is the middle
// of a side of squares. Two triangles share a hypotenuse and are split together, so there are no cracks, and
// the split of a triangle asks for that of the two whose halves it is.
constexpr int tile = 64;

class Hierarchy {
 public:
  Hierarchy(const GridMesh& mesh, const ColorImage8* colors, const FitLimits& limits)
      : mesh_(mesh), colors_(colors), limits_(limits), split_(mesh.size(), 0) {
    for (int size = 2; size <= tile; size *= 2) {
      decide_sides(size);
      decide_centers(size);
    }
  }

  // Whether the triangles whose hypotenuse has this middle are split; always, outside of the picture.
  [[nodiscard]] bool is_split(Pixel middle) const {
    return !inside(middle) || split_(middle.x, middle.y) != 0;
  }

  // Whether the diagonal of a square in column i and row j of squares runs from the top left.
  [[nodiscard]] static bool falls(int i, int j) { return ((i + j) & 1) == 0; }

 private:
  [[nodiscard]] bool inside(Pixel p) const {
    return p.x >= 0 && p.y >= 0 && p.x < split_.width() && p.y < split_.height();
  }

  [[nodiscard]] bool is_full(int x, int y) const {
    return inside({x, y}) && (mesh_.cells()(x, y) & cell::full) == cell::full;
  }

  [[nodiscard]] bool fits(Pixel p, Pixel q, Pixel r) const {
    return triangle_fits(mesh_.grid().points, colors_, {p, q, r}, limits_);
  }

  // Middles of the sides of squares of `size`, upright and level.
  void decide_sides(int size) {
    const int half = size / 2;
    const int rows = (split_.height() + half - 1) / half;
    parallel_for(0, rows, std::max(1, 64 / half), [&](int first, int last) {
      for (int row = first; row < last; ++row) {
        const int y = row * half;
        for (int x = row % 2 == 0 ? half : 0; x < split_.width(); x += size) {
          split_(x, y) = side_must_split({x, y}, half, row % 2 == 0);
        }
      }
    });
  }

  [[nodiscard]] bool side_must_split(Pixel m, int half, bool level) const {
    if (half == 1) {
      const bool all =
          is_full(m.x - 1, m.y - 1) && is_full(m.x, m.y - 1) && is_full(m.x - 1, m.y) && is_full(m.x, m.y);
      if (!all) return true;
    } else {
      const int quarter = half / 2;
      for (const int dy : {-quarter, quarter}) {
        for (const int dx : {-quarter, quarter}) {
          if (is_split({m.x + dx, m.y + dy})) return true;
        }
      }
    }
    const Pixel left{m.x - half, m.y};
    const Pixel right{m.x + half, m.y};
    const Pixel up{m.x, m.y - half};
    const Pixel down{m.x, m.y + half};
    return level ? !(fits(left, right, up) && fits(left, right, down))
                 : !(fits(up, down, left) && fits(up, down, right));
  }

  // Centres of squares of `size`.
  void decide_centers(int size) {
    const int half = size / 2;
    const int rows = (split_.height() - half + size - 1) / size;
    parallel_for(0, rows, std::max(1, 64 / size), [&](int first, int last) {
      for (int j = first; j < last; ++j) {
        for (int i = 0; i * size + half < split_.width(); ++i) {
          const Pixel center{i * size + half, j * size + half};
          split_(center.x, center.y) = center_must_split(center, half, falls(i, j));
        }
      }
    });
  }

  [[nodiscard]] bool center_must_split(Pixel m, int half, bool falling) const {
    const bool side = is_split({m.x - half, m.y}) || is_split({m.x + half, m.y}) ||
                      is_split({m.x, m.y - half}) || is_split({m.x, m.y + half});
    if (side) return true;
    const Pixel a{m.x - half, m.y - half};
    const Pixel b{m.x + half, m.y - half};
    const Pixel c{m.x - half, m.y + half};
    const Pixel d{m.x + half, m.y + half};
    return falling ? !(fits(a, d, b) && fits(a, d, c)) : !(fits(b, c, a) && fits(b, c, d));
  }

  const GridMesh& mesh_;
  const ColorImage8* colors_;
  FitLimits limits_;
  Image<std::uint8_t> split_;
};

// Walks the hierarchy down and collects faces whose indices are pixel numbers.
class Collector {
 public:
  Collector(const GridMesh& mesh, const Hierarchy& hierarchy) : mesh_(mesh), hierarchy_(hierarchy) {}

  void collect_tile(int i, int j) {
    const Pixel a{i * tile, j * tile};
    const Pixel b{a.x + tile, a.y};
    const Pixel c{a.x, a.y + tile};
    const Pixel d{a.x + tile, a.y + tile};
    if (Hierarchy::falls(i, j)) {
      collect(d, a, c);
      collect(a, d, b);
    } else {
      collect(c, b, a);
      collect(b, c, d);
    }
  }

  [[nodiscard]] std::vector<Face> take() { return std::move(faces_); }

 private:
  // The triangle (p, q, apex), counter-clockwise, its hypotenuse from p to q.
  void collect(Pixel p, Pixel q, Pixel apex) {
    const bool half_cell = std::abs(p.x - q.x) == 1 && std::abs(p.y - q.y) == 1;
    if (half_cell) return collect_half_cell(p, q, apex);
    const Pixel middle{(p.x + q.x) / 2, (p.y + q.y) / 2};
    if (!hierarchy_.is_split(middle)) return add(p, q, apex);
    collect(apex, p, middle);
    collect(q, apex, middle);
  }

  // Cells that are not full keep the triangles they have; both their halves come here, the upper one counts.
  void collect_half_cell(Pixel p, Pixel q, Pixel apex) {
    const Pixel a{std::min(p.x, q.x), std::min(p.y, q.y)};
    if (a.x + 1 >= mesh_.size().width || a.y + 1 >= mesh_.size().height) return;
    const unsigned code = mesh_.cells()(a.x, a.y);
    if ((code & cell::full) == cell::full) return add(p, q, apex);
    if (apex.y != a.y) return;
    const Pixel b{a.x + 1, a.y};
    const Pixel c{a.x, a.y + 1};
    const Pixel d{a.x + 1, a.y + 1};
    if (code & cell::first) add(a, c, code & cell::anti ? b : d);
    if (code & cell::second) code& cell::anti ? add(b, c, d) : add(a, d, b);
  }

  void add(Pixel p, Pixel q, Pixel r) { faces_.push_back({number(p), number(q), number(r)}); }

  [[nodiscard]] std::uint32_t number(Pixel p) const {
    return static_cast<std::uint32_t>(p.y) * static_cast<std::uint32_t>(mesh_.size().width) +
           static_cast<std::uint32_t>(p.x);
  }

  const GridMesh& mesh_;
  const Hierarchy& hierarchy_;
  std::vector<Face> faces_;
};

std::vector<Face> collect_faces(const GridMesh& mesh, const Hierarchy& hierarchy) {
  const int columns = (mesh.size().width + tile - 1) / tile;
  const int rows = (mesh.size().height + tile - 1) / tile;
  std::vector<std::vector<Face>> parts(static_cast<std::size_t>(rows));
  parallel_for(0, rows, 1, [&](int first, int last) {
    for (int j = first; j < last; ++j) {
      Collector collector(mesh, hierarchy);
      for (int i = 0; i < columns; ++i) collector.collect_tile(i, j);
      parts[static_cast<std::size_t>(j)] = collector.take();
    }
  });
  std::size_t count = 0;
  for (const auto& part : parts) count += part.size();
  std::vector<Face> faces;
  faces.reserve(count);
  for (auto& part : parts) {
    faces.insert(faces.end(), part.begin(), part.end());
    part = {};
  }
  return faces;
}

// Points and colours of the pixels that the faces name; the faces' indices become theirs.
Mesh gather(const GridMesh& mesh, const ColorImage8* colors, std::vector<Face> faces) {
  Image<std::uint32_t> numbers(mesh.size(), 0);
  std::uint32_t* number = numbers.data();
  for (const Face& face : faces) {
    for (const std::uint32_t pixel : face) number[pixel] = 1;
  }
  Mesh result;
  for (std::size_t pixel = 0; pixel < mesh.size().area(); ++pixel) {
    if (number[pixel] == 0) continue;
    number[pixel] = static_cast<std::uint32_t>(result.points.size());
    result.points.push_back(mesh.grid().points.data()[pixel]);
    if (colors) result.colors.push_back(colors->data()[pixel]);
  }
  for (Face& face : faces) {
    for (std::uint32_t& pixel : face) pixel = number[pixel];
  }
  result.faces = std::move(faces);
  return result;
}

}  // namespace

Expected<void> SimplifyOptions::check() const {
  const auto refuse = [](const char* what) {
    return tl::unexpected(Error{ErrorKind::usage, std::string("simplify: ") + what});
  };
  if (!(max_error_mm > 0)) return refuse("max_error_mm: not positive");
  if (!(max_color_error > 0)) return refuse("max_color_error: not positive");
  return {};
}

Expected<Mesh> simplify(const GridMesh& mesh, const SurfaceColor* colors, const SimplifyOptions& options) {
  if (auto checked = options.check(); !checked) return tl::unexpected(checked.error());
  if (colors && colors->size() != mesh.size())
    return input_error("simplify: the colours are of another size");
  const ColorImage8 image = colors ? colors->image() : ColorImage8();
  const ColorImage8* colored = colors ? &image : nullptr;
  const FitLimits limits{.error_mm = static_cast<float>(options.max_error_mm),
                         .color = static_cast<float>(options.max_color_error)};
  const Hierarchy hierarchy(mesh, colored, limits);
  return gather(mesh, colored, collect_faces(mesh, hierarchy));
}

}  // namespace bodyscan
