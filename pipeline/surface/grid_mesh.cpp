#include "pipeline/surface/grid_mesh.hpp"

#include "pipeline/base/instruction_set.hpp"
#include "pipeline/base/parallel.hpp"
#include "pipeline/surface/corners.hpp"

#include <algorithm>
#include <utility>

namespace bodyscan {
namespace {

constexpr std::size_t chunk_items = 1U << 18;  // 3 MB of faces: a few a thread stay in the last-level cache

struct RowTotals {
  int points = 0;
  int faces = 0;
};

struct UsedKernel {
  // used[x] = 1 where a triangle of cell row y (`here`) or the one above (all 0 for the first row) uses (x,
  // y).
  BODYSCAN_KERNEL void run(const std::uint8_t* above, const std::uint8_t* here, int width, std::uint8_t* used,
                           RowTotals* totals) {
    used[0] = static_cast<std::uint8_t>(corners::a(here[0]) | corners::c(above[0]));
    for (int x = 1; x < width; ++x) {
      used[x] = static_cast<std::uint8_t>(corners::a(here[x]) | corners::b(here[x - 1]) |
                                          corners::c(above[x]) | corners::d(above[x - 1]));
    }
    int points = 0;
    int faces = 0;
    for (int x = 0; x < width; ++x) {
      points += used[x];
      faces += (here[x] & 1) + (here[x] >> 1 & 1);
    }
    totals->points = points;
    totals->faces = faces;
  }
};

struct MarkKernel {
  BODYSCAN_KERNEL void run(const std::uint8_t* used, int width, std::uint8_t* cells) {
    for (int x = 0; x < width; ++x) {
      cells[x] = static_cast<std::uint8_t>((cells[x] & 7U) | static_cast<unsigned>(used[x]) << 3);
    }
  }
};

}  // namespace

GridMesh::GridMesh(PointGrid grid, Image<std::uint8_t> cells)
    : grid_(std::move(grid)), cells_(std::move(cells)) {
  number_rows();
}

void GridMesh::number_rows() {
  const int width = cells_.width();
  const int height = cells_.height();
  const auto rows = static_cast<std::size_t>(height);
  point_begin_.assign(rows + 1, 0);
  face_begin_.assign(rows + 1, 0);
  parallel_for(0, height, 128, [&](int first, int last) {
    const std::vector<std::uint8_t> nothing(static_cast<std::size_t>(width), 0);
    std::vector<std::uint8_t> used(nothing);
    for (int y = first; y < last; ++y) {
      RowTotals totals;
      run_kernel<UsedKernel>(y > 0 ? cells_.row(y - 1) : nothing.data(), std::as_const(cells_).row(y), width,
                             used.data(), &totals);
      run_kernel<MarkKernel>(used.data(), width, cells_.row(y));
      point_begin_[static_cast<std::size_t>(y) + 1] = static_cast<std::size_t>(totals.points);
      face_begin_[static_cast<std::size_t>(y) + 1] = static_cast<std::size_t>(totals.faces);
    }
  });
  for (std::size_t y = 0; y < rows; ++y) {
    point_begin_[y + 1] += point_begin_[y];
    face_begin_[y + 1] += face_begin_[y];
  }
}

double GridMesh::mean_sigma_mm() const {
  std::vector<double> sums(static_cast<std::size_t>(cells_.height()), 0);
  parallel_for(0, cells_.height(), 64, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      const std::uint8_t* cells = cells_.row(y);
      const float* sigma = grid_.sigma_mm.row(y);
      double sum = 0;
      for (int x = 0; x < cells_.width(); ++x) sum += cells[x] & cell::used ? sigma[x] : 0.F;
      sums[static_cast<std::size_t>(y)] = sum;
    }
  });
  double total = 0;
  for (const double sum : sums) total += sum;
  return point_count() == 0 ? 0 : total / static_cast<double>(point_count());
}

int GridMesh::chunk_end(int first, const std::vector<std::size_t>& begin, std::size_t items) const {
  const auto from = begin.begin() + first;
  const auto end = std::upper_bound(from + 1, begin.end(), *from + items);
  return std::min(cells_.height(), std::max(first + 1, static_cast<int>(end - begin.begin()) - 1));
}

void GridMesh::points_of_row(int y, Point3f* out) const {
  const std::uint8_t* cells = cells_.row(y);
  const Point3f* points = grid_.points.row(y);
  for (int x = 0; x < cells_.width(); ++x) {
    if (cells[x] & cell::used) *out++ = points[x];
  }
}

void GridMesh::faces_of_row(int y, Face* out) const {
  const std::uint8_t* here = cells_.row(y);
  const std::uint8_t* below = cells_.row(std::min(y + 1, cells_.height() - 1));
  auto a = static_cast<std::uint32_t>(point_begin_[static_cast<std::size_t>(y)]);
  auto c = static_cast<std::uint32_t>(point_begin_[static_cast<std::size_t>(y) + 1]);
  for (int x = 0; x < cells_.width(); ++x) {
    const unsigned code = here[x];
    const std::uint32_t b = a + (code >> 3 & 1U);
    const std::uint32_t d = c + (below[x] >> 3 & 1U);
    if (code & cell::anti) {
      if (code & cell::first) *out++ = {a, c, b};
      if (code & cell::second) *out++ = {b, c, d};
    } else {
      if (code & cell::first) *out++ = {a, c, d};
      if (code & cell::second) *out++ = {a, d, b};
    }
    a = b;
    c = d;
  }
}

Expected<void> GridMesh::for_each_points(const ChunkSink<Point3f>& sink) const {
  std::vector<Point3f> chunk;
  for (int first = 0; first < cells_.height();) {
    const int last = chunk_end(first, point_begin_, chunk_items);
    const std::size_t base = point_begin_[static_cast<std::size_t>(first)];
    chunk.resize(point_begin_[static_cast<std::size_t>(last)] - base);
    parallel_for(first, last, 8, [&](int begin, int end) {
      for (int y = begin; y < end; ++y) {
        points_of_row(y, chunk.data() + (point_begin_[static_cast<std::size_t>(y)] - base));
      }
    });
    if (!chunk.empty()) {
      if (auto taken = sink(chunk); !taken) return taken;
    }
    first = last;
  }
  return {};
}

Expected<void> GridMesh::for_each_colors(const SurfaceColor& colors, const ChunkSink<Rgb8>& sink) const {
  std::vector<Rgb8> chunk;
  for (int first = 0; first < cells_.height();) {
    const int last = chunk_end(first, point_begin_, chunk_items);
    const std::size_t base = point_begin_[static_cast<std::size_t>(first)];
    chunk.resize(point_begin_[static_cast<std::size_t>(last)] - base);
    parallel_for(first, last, 8, [&](int begin, int end) {
      std::vector<Rgb8> row(static_cast<std::size_t>(cells_.width()));
      for (int y = begin; y < end; ++y) {
        colors.row(y, row.data());
        Rgb8* out = chunk.data() + (point_begin_[static_cast<std::size_t>(y)] - base);
        const std::uint8_t* cells = cells_.row(y);
        for (std::size_t x = 0; x < row.size(); ++x) {
          if (cells[x] & cell::used) *out++ = row[x];
        }
      }
    });
    if (!chunk.empty()) {
      if (auto taken = sink(chunk); !taken) return taken;
    }
    first = last;
  }
  return {};
}

Expected<void> GridMesh::for_each_faces(const ChunkSink<Face>& sink) const {
  std::vector<Face> chunk;
  for (int first = 0; first < cells_.height();) {
    const int last = chunk_end(first, face_begin_, chunk_items);
    const std::size_t base = face_begin_[static_cast<std::size_t>(first)];
    chunk.resize(face_begin_[static_cast<std::size_t>(last)] - base);
    parallel_for(first, last, 8, [&](int begin, int end) {
      for (int y = begin; y < end; ++y) {
        faces_of_row(y, chunk.data() + (face_begin_[static_cast<std::size_t>(y)] - base));
      }
    });
    if (!chunk.empty()) {
      if (auto taken = sink(chunk); !taken) return taken;
    }
    first = last;
  }
  return {};
}

Mesh GridMesh::to_mesh(const SurfaceColor* colors) const {
  Mesh mesh;
  mesh.points.reserve(point_count());
  mesh.faces.reserve(face_count());
  const auto append = [](auto& all) {
    return [&all](auto chunk) -> Expected<void> {
      all.insert(all.end(), chunk.begin(), chunk.end());
      return {};
    };
  };
  // Appending cannot fail.
  (void)for_each_points(append(mesh.points));
  (void)for_each_faces(append(mesh.faces));
  if (colors) {
    mesh.colors.reserve(point_count());
    (void)for_each_colors(*colors, append(mesh.colors));
  }
  return mesh;
}

}  // namespace bodyscan
