#include "pipeline/board/saddle_points.hpp"

#include "pipeline/base/parallel.hpp"
#include "pipeline/board/sampling.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numbers>
#include <utility>

#include <Eigen/Eigenvalues>

namespace bodyscan {
namespace {

constexpr int rows_a_task = 32;
constexpr int ring_samples = 16;
constexpr double min_ring_likeness = 0.5;  // correlation of opposite sides

struct Hessian {
  float xx;
  float xy;
  float yy;
  [[nodiscard]] float saddle() const { return xy * xy - xx * yy; }  // minus the determinant
};

Hessian hessian_at(const FloatImage& image, int x, int y) {
  return {image(x - 1, y) - 2 * image(x, y) + image(x + 1, y),
          (image(x + 1, y + 1) - image(x - 1, y + 1) - image(x + 1, y - 1) + image(x - 1, y - 1)) / 4,
          image(x, y - 1) - 2 * image(x, y) + image(x, y + 1)};
}

// The extremum of the saddle surface about a pixel: where the gradient of a quadratic vanishes.
Eigen::Vector2d refine(const FloatImage& image, int x, int y, const Hessian& h) {
  const double gx = static_cast<double>(image(x + 1, y) - image(x - 1, y)) / 2;
  const double gy = static_cast<double>(image(x, y + 1) - image(x, y - 1)) / 2;
  const double determinant = -static_cast<double>(h.saddle());
  const Eigen::Vector2d step(
      -(static_cast<double>(h.yy) * gx - static_cast<double>(h.xy) * gy) / determinant,
      -(static_cast<double>(h.xx) * gy - static_cast<double>(h.xy) * gx) / determinant);
  return Eigen::Vector2d(x, y) + step.cwiseMax(-1.5).cwiseMin(1.5);
}

struct Ring {
  double deviation = 0;  // standard deviation of the samples
  double likeness = 0;   // correlation of each sample with the one opposite
  int changes = 0;       // of sign about the mean, around the circle
};

Ring look_around(const FloatImage& image, const Eigen::Vector2d& at, double radius) {
  std::array<double, ring_samples> values{};
  double mean = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / ring_samples;
    values[i] = sample(image, at + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    mean += values[i] / ring_samples;
  }
  Ring ring;
  double opposite = 0;
  double squares = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double here = values[i] - mean;
    const double across = values[(i + ring_samples / 2) % ring_samples] - mean;
    const double next = values[(i + 1) % ring_samples] - mean;
    opposite += here * across;
    squares += here * here;
    ring.changes += (here > 0) != (next > 0);
  }
  ring.deviation = std::sqrt(squares / ring_samples);
  ring.likeness = squares > 0 ? opposite / squares : 0;
  return ring;
}

// The edges run where the second derivative vanishes, between the Hessian's eigenvectors.
SaddlePoint describe(const Eigen::Vector2d& at, const Hessian& h, float strength) {
  const Eigen::Matrix2d matrix = (Eigen::Matrix2d() << static_cast<double>(h.xx), static_cast<double>(h.xy),
                                  static_cast<double>(h.xy), static_cast<double>(h.yy))
                                     .finished();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(matrix);
  const double falling = -solver.eigenvalues()[0];  // curvature along the first eigenvector is negative
  const double rising = solver.eigenvalues()[1];
  const Eigen::Vector2d down = solver.eigenvectors().col(0);  // towards the dark squares' middles
  const Eigen::Vector2d up = solver.eigenvectors().col(1);
  const double a = std::sqrt(rising / (falling + rising));
  const double b = std::sqrt(falling / (falling + rising));
  SaddlePoint point{
      at, {Eigen::Vector2d(a * down + b * up), Eigen::Vector2d(a * down - b * up)}, false, strength};
  // edges[0] to the right half, so that directions compare; the bright sector holds `up`.
  for (Eigen::Vector2d& edge : point.edges) {
    if (edge.x() < 0 || (edge.x() == 0 && edge.y() < 0)) edge = -edge;
  }
  if (std::atan2(point.edges[0].y(), point.edges[0].x()) > std::atan2(point.edges[1].y(), point.edges[1].x()))
    std::swap(point.edges[0], point.edges[1]);
  const Eigen::Vector2d middle = point.edges[0] + point.edges[1];
  point.positive = std::abs(middle.dot(up)) > std::abs(middle.dot(down));
  return point;
}

std::vector<float> gaussian_weights(float sigma_px) {
  const int radius = std::max(1, static_cast<int>(std::ceil(3 * sigma_px)));
  std::vector<float> weights;
  float sum = 0;
  for (int i = -radius; i <= radius; ++i) {
    weights.push_back(std::exp(-0.5F * static_cast<float>(i * i) / (sigma_px * sigma_px)));
    sum += weights.back();
  }
  for (float& weight : weights) weight /= sum;
  return weights;
}

}  // namespace

FloatImage gaussian_blur(const FloatImage& image, float sigma_px) {
  const std::vector<float> weights = gaussian_weights(sigma_px);
  const int radius = static_cast<int>(weights.size() / 2);
  const Size size = image.size();
  FloatImage across(size);
  FloatImage blurred(size, 0);
  parallel_for(0, size.height, rows_a_task, [&](int first, int last) {
    std::vector<float> padded(static_cast<std::size_t>(size.width + 2 * radius));
    for (int y = first; y < last; ++y) {
      for (int x = -radius; x < size.width + radius; ++x)
        padded[static_cast<std::size_t>(x + radius)] = image(std::clamp(x, 0, size.width - 1), y);
      float* out = across.row(y);
      std::fill_n(out, size.width, 0.0F);
      for (std::size_t i = 0; i < weights.size(); ++i)
        for (int x = 0; x < size.width; ++x) out[x] += weights[i] * padded[static_cast<std::size_t>(x) + i];
    }
  });
  parallel_for(0, size.height, rows_a_task, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      float* out = blurred.row(y);
      for (std::size_t i = 0; i < weights.size(); ++i) {
        const float* row = across.row(std::clamp(y + static_cast<int>(i) - radius, 0, size.height - 1));
        for (int x = 0; x < size.width; ++x) out[x] += weights[i] * row[x];
      }
    }
  });
  return blurred;
}

std::vector<SaddlePoint> find_saddle_points(const FloatImage& image, const SaddleOptions& options) {
  const int border = static_cast<int>(std::ceil(options.ring_px)) + 1;
  if (std::min(image.width(), image.height()) <= 2 * border) return {};
  const FloatImage smooth = gaussian_blur(image, options.blur_px);
  const Size size = smooth.size();
  FloatImage saddle(size, 0);
  parallel_for(1, size.height - 1, rows_a_task, [&](int first, int last) {
    for (int y = first; y < last; ++y)
      for (int x = 1; x < size.width - 1; ++x) saddle(x, y) = hessian_at(smooth, x, y).saddle();
  });
  const float curvature_unit = options.blur_px * options.blur_px + 0.1F;
  std::vector<SaddlePoint> points;
  std::mutex mutex;
  parallel_for(border, size.height - border, rows_a_task, [&](int first, int last) {
    std::vector<SaddlePoint> here;
    for (int y = first; y < last; ++y) {
      for (int x = border; x < size.width - border; ++x) {
        const float value = saddle(x, y);
        if (!(value > 0)) continue;
        bool largest = true;
        for (int dy = -2; dy <= 2 && largest; ++dy)
          for (int dx = -2; dx <= 2; ++dx)
            largest &= saddle(x + dx, y + dy) < value ||
                       (saddle(x + dx, y + dy) == value && (dy < 0 || (dy == 0 && dx <= 0)));
        if (!largest) continue;
        const Hessian h = hessian_at(smooth, x, y);
        const Eigen::Vector2d at = refine(smooth, x, y, h);
        const Ring ring = look_around(smooth, at, static_cast<double>(options.ring_px));
        if (ring.deviation < static_cast<double>(options.min_deviation) || ring.changes != 4 ||
            ring.likeness < min_ring_likeness)
          continue;
        const float strength = std::sqrt(value) * curvature_unit / static_cast<float>(ring.deviation);
        if (strength >= options.min_strength) here.push_back(describe(at, h, strength));
      }
    }
    const std::lock_guard lock(mutex);
    points.insert(points.end(), here.begin(), here.end());
  });
  // In reading order, so that the result does not depend on the threads.
  std::ranges::sort(points, [](const SaddlePoint& a, const SaddlePoint& b) {
    return a.at.y() != b.at.y() ? a.at.y() < b.at.y() : a.at.x() < b.at.x();
  });
  return points;
}

}  // namespace bodyscan
