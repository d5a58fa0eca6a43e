#include "tools/simulator/projected_picture.hpp"

#include "pipeline/base/parallel.hpp"
#include "tools/simulator/box_blur.hpp"

#include <algorithm>
#include <span>

namespace bodyscan::simulator {
namespace {

constexpr int rows_at_once = 16;

bool rows_are_uniform(const FloatImage& picture) {
  for (int y = 0; y < picture.height(); ++y) {
    const float* row = picture.row(y);
    if (std::any_of(row, row + picture.width(), [&](float pixel) { return pixel != row[0]; })) return false;
  }
  return true;
}

bool columns_are_uniform(const FloatImage& picture) {
  for (int y = 1; y < picture.height(); ++y) {
    if (!std::equal(picture.row(y), picture.row(y) + picture.width(), picture.row(0))) return false;
  }
  return true;
}

}  // namespace

std::optional<Axis> changing_axis(const FloatImage& picture) {
  if (rows_are_uniform(picture)) return Axis::row;
  if (columns_are_uniform(picture)) return Axis::column;
  return std::nullopt;
}

std::vector<float> pixels_along(const FloatImage& picture, Axis axis) {
  if (axis == Axis::column) return {picture.row(0), picture.row(0) + picture.width()};
  std::vector<float> pixels;
  for (int y = 0; y < picture.height(); ++y) pixels.push_back(*picture.row(y));
  return pixels;
}

ProjectedPicture::ProjectedPicture(const FloatImage& picture, double defocus, double scattered)
    : focused_(tabulate(picture, defocus)) {
  if (scattered > defocus) scattered_ = tabulate(picture, scattered);
  double sum = 0;
  for (const float pixel : picture.pixels()) sum += static_cast<double>(pixel);
  mean_ = static_cast<float>(sum / static_cast<double>(picture.size().area()));
}

ProjectedPicture::Table ProjectedPicture::tabulate(const FloatImage& picture, double sigma) {
  const int samples = sigma > 2 ? 2 : 4;
  const BoxBlur blur(sigma, samples, margin);
  FloatImage rows({blur.count(picture.width()), picture.height()});
  parallel_for(0, picture.height(), rows_at_once, [&](int begin, int end) {
    for (int y = begin; y < end; ++y)
      std::ranges::copy(blur.blur({picture.row(y), static_cast<std::size_t>(picture.width())}), rows.row(y));
  });
  Table table{FloatImage({rows.width(), blur.count(picture.height())}, 0), static_cast<float>(samples)};
  parallel_for(0, table.samples.height(), rows_at_once, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      float* sum = table.samples.row(y);
      int pixel = blur.first_pixel(y);
      for (const double weight : blur.weights(y)) {
        const float* row = rows.row(std::clamp(pixel++, 0, picture.height() - 1));
        const auto share = static_cast<float>(weight);
        for (int x = 0; x < rows.width(); ++x) sum[x] += share * row[x];
      }
    }
  });
  return table;
}

}  // namespace bodyscan::simulator
