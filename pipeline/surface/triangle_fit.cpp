#include "pipeline/surface/triangle_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace bodyscan {
namespace {

// The pixels of row y that a triangle covers: [begin, end].
struct Span {
  int begin;
  int end;
};

class Footprint {
 public:
  explicit Footprint(const std::array<Pixel, 3>& corners) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Pixel& p = corners[i];
      const Pixel& q = corners[(i + 1) % 3];
      const int rows = q.y - p.y;
      sides_[i] = {p, q, rows == 0 ? 0 : (q.x - p.x) / rows};
    }
    first_ = std::min({corners[0].y, corners[1].y, corners[2].y});
    last_ = std::max({corners[0].y, corners[1].y, corners[2].y});
  }

  [[nodiscard]] int first() const { return first_; }
  [[nodiscard]] int last() const { return last_; }
  [[nodiscard]] Span span(int y) const {
    Span span{std::numeric_limits<int>::max(), std::numeric_limits<int>::min()};
    for (const Side& side : sides_) {
      if (y < std::min(side.p.y, side.q.y) || y > std::max(side.p.y, side.q.y)) continue;
      const int x = side.p.x + side.step * (y - side.p.y);
      const int other = side.p.y == side.q.y ? side.q.x : x;
      span.begin = std::min({span.begin, x, other});
      span.end = std::max({span.end, x, other});
    }
    return span;
  }

 private:
  struct Side {
    Pixel p;
    Pixel q;
    int step;  // in x for each row down: -1, 0 or 1
  };

  std::array<Side, 3> sides_;
  int first_;
  int last_;
};

Eigen::Vector3f vector(const Point3f& p) {
  return {p.x, p.y, p.z};
}

// The plane of a triangle and, by its dual basis, the barycentric coordinates of a point's foot on it.
struct Plane {
  Eigen::Vector3f origin;
  Eigen::Vector3f normal;
  Eigen::Vector3f second;  // weight of the second corner is second . (P - origin)
  Eigen::Vector3f third;
  float from_camera;  // normal . origin
};

Plane plane_through(const Eigen::Vector3f& p, const Eigen::Vector3f& q, const Eigen::Vector3f& r) {
  const Eigen::Vector3f to_q = q - p;
  const Eigen::Vector3f to_r = r - p;
  const Eigen::Vector3f cross = to_q.cross(to_r);
  const float squared = cross.squaredNorm();
  const Eigen::Vector3f normal = cross / std::sqrt(squared);
  return {.origin = p,
          .normal = normal,
          .second = to_r.cross(cross) / squared,
          .third = cross.cross(to_q) / squared,
          .from_camera = normal.dot(p)};
}

bool points_fit(const Plane& plane, const Point3f* points, int count, float limit) {
  int bad = 0;
  for (int i = 0; i < count; ++i) {
    const float x = points[i].x - plane.origin.x();
    const float y = points[i].y - plane.origin.y();
    const float z = points[i].z - plane.origin.z();
    const float height = plane.normal.x() * x + plane.normal.y() * y + plane.normal.z() * z;
    const float second = plane.second.x() * x + plane.second.y() * y + plane.second.z() * z;
    const float third = plane.third.x() * x + plane.third.y() * y + plane.third.z() * z;
    const int foot_inside = (second >= 0) & (third >= 0) & (second + third <= 1);
    // Along the ray the distance is |height| / cos(incidence), cos = |normal . P| / |P|.
    const float range2 = points[i].x * points[i].x + points[i].y * points[i].y + points[i].z * points[i].z;
    const float facing = plane.from_camera + height;
    const int ray_near = height * height * range2 <= limit * limit * facing * facing;
    bad |= !((std::abs(height) <= limit) & (foot_inside | ray_near));
  }
  return bad == 0;
}

// Linear functions of the pixel through the colours of three corners.
struct Gradient {
  std::array<float, 3> origin;
  std::array<float, 3> dx;
  std::array<float, 3> dy;

  Gradient(const ColorImage8& colors, const std::array<Pixel, 3>& corners) {
    const auto [p, q, r] = corners;
    const auto qx = static_cast<float>(q.x - p.x);
    const auto qy = static_cast<float>(q.y - p.y);
    const auto rx = static_cast<float>(r.x - p.x);
    const auto ry = static_cast<float>(r.y - p.y);
    const float scale = 1 / (qx * ry - qy * rx);
    for (std::size_t i = 0; i < 3; ++i) {
      const float base = colors(p.x, p.y)[i];
      const float to_q = static_cast<float>(colors(q.x, q.y)[i]) - base;
      const float to_r = static_cast<float>(colors(r.x, r.y)[i]) - base;
      dx[i] = (to_q * ry - to_r * qy) * scale;
      dy[i] = (to_r * qx - to_q * rx) * scale;
      origin[i] = base;
    }
  }
};

bool colors_fit(const Gradient& gradient, const Rgb8* colors, int count, Pixel offset, float limit) {
  int bad = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const float start = gradient.origin[i] + gradient.dx[i] * static_cast<float>(offset.x) +
                        gradient.dy[i] * static_cast<float>(offset.y);
    for (int x = 0; x < count; ++x) {
      const float expected = start + gradient.dx[i] * static_cast<float>(x);
      bad |= std::abs(static_cast<float>(colors[x][i]) - expected) > limit;
    }
  }
  return bad == 0;
}

}  // namespace

bool triangle_fits(const Image<Point3f>& points, const ColorImage8* colors,
                   const std::array<Pixel, 3>& corners, const FitLimits& limits) {
  const auto [p, q, r] = corners;
  const Plane plane =
      plane_through(vector(points(p.x, p.y)), vector(points(q.x, q.y)), vector(points(r.x, r.y)));
  const Footprint footprint(corners);
  for (int y = footprint.first(); y <= footprint.last(); ++y) {
    const Span span = footprint.span(y);
    if (!points_fit(plane, points.row(y) + span.begin, span.end - span.begin + 1, limits.error_mm))
      return false;
  }
  if (!colors) return true;
  const Gradient gradient(*colors, corners);
  for (int y = footprint.first(); y <= footprint.last(); ++y) {
    const Span span = footprint.span(y);
    const Pixel offset{span.begin - p.x, y - p.y};
    if (!colors_fit(gradient, colors->row(y) + span.begin, span.end - span.begin + 1, offset, limits.color)) {
      return false;
    }
  }
  return true;
}

}  // namespace bodyscan
