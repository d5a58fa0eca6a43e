#include "pipeline/preview/coarse_mesh.hpp"

#include "pipeline/base/parallel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace bodyscan {
namespace {

using Eigen::Vector3f;

// Neighbouring vertices are joined up to this depth difference in units of their distance across (76
// degrees): what is steeper is ragged, and a turned view shows it.
constexpr float max_slope = 4;

// Points of a block lie on one surface if their depths differ by less than this share.
constexpr float same_surface = 0.01F;

// The transfer curve's exponent; close enough for a picture.
constexpr float gamma = 2.2F;

struct Block {
  Vector3f position{0, 0, 0};
  Vector3f color{0, 0, 0};
  int count = 0;
};

Vector3f vector(const Point3f& p) {
  return {p.x, p.y, p.z};
}

// The vertices of one row of blocks.
class BlockRow {
 public:
  BlockRow(const GridMesh& mesh, const SurfaceColor* colors, int step, int j)
      : mesh_(mesh), step_(step), top_(j * step), bottom_(std::min(top_ + step, mesh.size().height)) {
    if (!colors) return;
    const auto width = static_cast<std::size_t>(mesh.size().width);
    colors_.resize(width * static_cast<std::size_t>(bottom_ - top_));
    for (int y = top_; y < bottom_; ++y)
      colors->row(y, colors_.data() + width * static_cast<std::size_t>(y - top_));
  }

  [[nodiscard]] Block block(int i) const {
    const int left = i * step_;
    const int right = std::min(left + step_, mesh_.size().width);
    Block block;
    const float depth = middle_depth(left, right);
    for (int y = top_; y < bottom_; ++y) {
      for (int x = left; x < right; ++x) {
        if (!mesh_.has(x, y)) continue;
        const Point3f& point = mesh_.grid().points(x, y);
        if (std::abs(point.z - depth) > same_surface * depth) continue;
        block.position += vector(point);
        block.color += color(x, y);
        ++block.count;
      }
    }
    if (block.count == 0) return block;
    block.position /= static_cast<float>(block.count);
    block.color /= static_cast<float>(block.count);
    return block;
  }

 private:
  [[nodiscard]] float middle_depth(int left, int right) const {
    const int mid_x = (left + right) / 2;
    const int mid_y = (top_ + bottom_) / 2;
    int nearest = std::numeric_limits<int>::max();
    float depth = 0;
    for (int y = top_; y < bottom_; ++y) {
      for (int x = left; x < right; ++x) {
        const int distance = (x - mid_x) * (x - mid_x) + (y - mid_y) * (y - mid_y);
        if (distance >= nearest || !mesh_.has(x, y)) continue;
        nearest = distance;
        depth = mesh_.grid().points(x, y).z;
      }
    }
    return depth;
  }

  [[nodiscard]] Vector3f color(int x, int y) const {
    if (colors_.empty()) return Vector3f::Constant(0.6F);
    const auto width = static_cast<std::size_t>(mesh_.size().width);
    const Rgb8& rgb = colors_[width * static_cast<std::size_t>(y - top_) + static_cast<std::size_t>(x)];
    return Vector3f(rgb[0], rgb[1], rgb[2]) / 255;
  }

  const GridMesh& mesh_;
  int step_;
  int top_;
  int bottom_;
  std::vector<Rgb8> colors_;
};

bool joined(const Vector3f& p, const Vector3f& q) {
  const Vector3f ray = (p + q).normalized();
  const float along = std::abs((p - q).dot(ray));
  return along <= max_slope * std::sqrt(std::max(0.F, (p - q).squaredNorm() - along * along));
}

class Joiner {
 public:
  Joiner(CoarseMesh& mesh, const Image<std::int32_t>& numbers) : mesh_(mesh), numbers_(numbers) {}

  void join(int x, int y) {
    const std::int32_t a = numbers_(x, y);
    const std::int32_t b = numbers_(x + 1, y);
    const std::int32_t c = numbers_(x, y + 1);
    const std::int32_t d = numbers_(x + 1, y + 1);
    const bool all = a >= 0 && b >= 0 && c >= 0 && d >= 0;
    const bool falling = all ? depth_jump(a, d) <= depth_jump(b, c) : a >= 0 && d >= 0;
    if (falling) {
      add(a, c, d);
      add(a, d, b);
    } else {
      add(a, c, b);
      add(b, c, d);
    }
  }

 private:
  [[nodiscard]] const Vector3f& at(std::int32_t index) const {
    return mesh_.vertices[static_cast<std::size_t>(index)].position;
  }
  [[nodiscard]] float depth_jump(std::int32_t p, std::int32_t q) const {
    return std::abs(at(p).z() - at(q).z());
  }
  void add(std::int32_t p, std::int32_t q, std::int32_t r) {
    if (p < 0 || q < 0 || r < 0) return;
    if (!joined(at(p), at(q)) || !joined(at(q), at(r)) || !joined(at(r), at(p))) return;
    const Vector3f normal = (at(q) - at(p)).cross(at(r) - at(p));
    for (const std::int32_t index : {p, q, r})
      mesh_.vertices[static_cast<std::size_t>(index)].normal += normal;
    mesh_.faces.push_back(
        {static_cast<std::uint32_t>(p), static_cast<std::uint32_t>(q), static_cast<std::uint32_t>(r)});
  }

  CoarseMesh& mesh_;
  const Image<std::int32_t>& numbers_;
};

}  // namespace

CoarseMesh coarse_mesh(const GridMesh& mesh, const SurfaceColor* colors, int step) {
  const Size size{(mesh.size().width + step - 1) / step, (mesh.size().height + step - 1) / step};
  Image<Block> blocks(size);
  parallel_for(0, size.height, 4, [&](int first, int last) {
    for (int j = first; j < last; ++j) {
      const BlockRow row(mesh, colors, step, j);
      for (int i = 0; i < size.width; ++i) blocks(i, j) = row.block(i);
    }
  });
  CoarseMesh result;
  Image<std::int32_t> numbers(size, -1);
  for (std::size_t i = 0; i < size.area(); ++i) {
    const Block& block = blocks.data()[i];
    if (block.count == 0) continue;
    numbers.data()[i] = static_cast<std::int32_t>(result.vertices.size());
    result.vertices.push_back({block.position, Vector3f::Zero(), block.color.array().pow(gamma).matrix()});
  }
  Joiner joiner(result, numbers);
  for (int y = 0; y + 1 < size.height; ++y) {
    for (int x = 0; x + 1 < size.width; ++x) joiner.join(x, y);
  }
  for (CoarseVertex& vertex : result.vertices) vertex.normal.normalize();
  return result;
}

}  // namespace bodyscan
