#include "pipeline/geometry/triangulate.hpp"

#include "pipeline/base/instruction_set.hpp"
#include "pipeline/base/parallel.hpp"
#include "pipeline/base/size_text.hpp"
#include "pipeline/geometry/distortion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace bodyscan {
namespace {

constexpr int newton_steps = 4;
constexpr float none = std::numeric_limits<float>::quiet_NaN();

struct LensParameters {
  explicit LensParameters(const Lens& lens)
      : fx(static_cast<float>(lens.fx)),
        fy(static_cast<float>(lens.fy)),
        cx(static_cast<float>(lens.cx)),
        cy(static_cast<float>(lens.cy)),
        distortion(lens.distortion) {}
  float fx;
  float fy;
  float cx;
  float cy;
  Distortion<float> distortion;
};

struct Scene {
  explicit Scene(const Calibration& calibration)
      : camera(calibration.camera), projector(calibration.projector) {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j)
        r[i][j] = static_cast<float>(calibration.projector_from_camera.rotation(i, j));
      t[i] = static_cast<float>(calibration.projector_from_camera.translation(i));
    }
  }
  LensParameters camera;
  LensParameters projector;
  float r[3][3];
  float t[3];
};

// Camera rays (x/z, y/z) of columns [begin, end) of one row of pixels.
struct Rays {
  BODYSCAN_KERNEL void run(const LensParameters* lens, int y, int begin, int end, float* ray_x,
                           float* ray_y) {
    const Distortion<float> distortion = lens->distortion;
    const float yd = (static_cast<float>(y) - lens->cy) / lens->fy;
    BODYSCAN_VECTORIZE
    for (int x = begin; x < end; ++x) {
      const float xd = (static_cast<float>(x) - lens->cx) / lens->fx;
      float xi = xd;
      float yi = yd;
      BODYSCAN_UNROLL
      for (int i = 0; i < newton_steps; ++i) {
        const auto at = distortion(xi, yi);
        const float scale = 1 / (at.x_by_x * at.y_by_y - at.x_by_y * at.x_by_y);
        const float dx = xd - at.x;
        const float dy = yd - at.y;
        xi += (at.y_by_y * dx - at.x_by_y * dy) * scale;
        yi += (at.x_by_x * dy - at.x_by_y * dx) * scale;
      }
      ray_x[x] = xi;
      ray_y[x] = yi;
    }
  }
};

struct Measured {
  const float* row;
  const float* row_sigma;
  const float* column;
  const float* column_sigma;
};

struct Depths {
  BODYSCAN_KERNEL void run(const Scene* scene, TriangulateOptions options, Measured in, int begin, int end,
                           const float* ray_x, const float* ray_y, float* depth, float* sigma) {
    const Scene s = *scene;
    const LensParameters& p = s.projector;
    BODYSCAN_VECTORIZE
    for (int i = begin; i < end; ++i) {
      const float qx = s.r[0][0] * ray_x[i] + s.r[0][1] * ray_y[i] + s.r[0][2];
      const float qy = s.r[1][0] * ray_x[i] + s.r[1][1] * ray_y[i] + s.r[1][2];
      const float qz = s.r[2][0] * ray_x[i] + s.r[2][1] * ray_y[i] + s.r[2][2];

      const bool has_row = in.row[i] == in.row[i];
      const bool has_column = in.column[i] == in.column[i];
      const float row = has_row ? in.row[i] : 0;
      const float column = has_column ? in.column[i] : 0;
      const float row_weight = has_row ? 1 / (in.row_sigma[i] * in.row_sigma[i]) : 0;
      const float column_weight = has_column ? 1 / (in.column_sigma[i] * in.column_sigma[i]) : 0;

      // Without distortion the point lies where the ray meets the plane of the row or of the column; start
      // from the one that fixes the depth better.
      const float y0 = (row - p.cy) / p.fy;
      const float x0 = (column - p.cx) / p.fx;
      const float row_divisor = y0 * qz - qy;
      const float column_divisor = x0 * qz - qx;
      const bool by_row =
          row_divisor * row_divisor * row_weight >= column_divisor * column_divisor * column_weight;
      float z = by_row ? (s.t[1] - y0 * s.t[2]) / row_divisor : (s.t[0] - x0 * s.t[2]) / column_divisor;

      float information = 0;
      float row_error = 0;
      float column_error = 0;
      float behind = 0;
      BODYSCAN_UNROLL
      for (int step = 0; step <= newton_steps; ++step) {
        const float pz = z * qz + s.t[2];
        const float inverse = 1 / pz;
        const float x = (z * qx + s.t[0]) * inverse;
        const float y = (z * qy + s.t[1]) * inverse;
        const float x_by_z = (qx - x * qz) * inverse;
        const float y_by_z = (qy - y * qz) * inverse;
        const auto at = p.distortion(x, y);
        row_error = row - (p.fy * at.y + p.cy);
        column_error = column - (p.fx * at.x + p.cx);
        const float row_slope = p.fy * (at.x_by_y * x_by_z + at.y_by_y * y_by_z);
        const float column_slope = p.fx * (at.x_by_x * x_by_z + at.x_by_y * y_by_z);
        information = row_slope * row_slope * row_weight + column_slope * column_slope * column_weight;
        const float pull = row_slope * row_error * row_weight + column_slope * column_error * column_weight;
        z += step < newton_steps ? pull / information : 0;
        behind = pz;
      }
      const float calibration = options.calibration_px * options.calibration_px;
      const float misfit = row_error * row_error * row_weight / (1 + calibration * row_weight) +
                           column_error * column_error * column_weight / (1 + calibration * column_weight);
      const float deviation = 1 / std::sqrt(information);
      const bool agree = misfit <= options.max_disagreement * options.max_disagreement;
      const bool good =
          (has_row | has_column) & (z > 0) & (behind > 0) & (deviation <= options.max_sigma_mm) & agree;
      depth[i] = good ? z : none;
      sigma[i] = deviation;
    }
  }
};

// The columns outside of which nothing was measured.
std::pair<int, int> measured_range(const Measured& in, int width) {
  const auto known = [&](int x) { return in.row[x] == in.row[x] || in.column[x] == in.column[x]; };
  int begin = 0;
  while (begin < width && !known(begin)) ++begin;
  int end = width;
  while (end > begin && !known(end - 1)) --end;
  return {begin, end};
}

}  // namespace

Expected<void> TriangulateOptions::check() const {
  if (!(max_sigma_mm > 0)) return tl::unexpected(Error{ErrorKind::usage, "max_sigma_mm must be positive"});
  if (!(calibration_px >= 0))
    return tl::unexpected(Error{ErrorKind::usage, "calibration_px must not be negative"});
  if (!(max_disagreement > 0))
    return tl::unexpected(Error{ErrorKind::usage, "max_disagreement must be positive"});
  return {};
}

Expected<PointGrid> triangulate(const Correspondence& correspondence, const Calibration& calibration,
                                const TriangulateOptions& options) {
  if (auto checked = options.check(); !checked) return tl::unexpected(checked.error());
  if (correspondence.camera != calibration.camera.size)
    return input_error("the calibration is for a camera of " + text_of(calibration.camera.size) +
                       " pixels, the frames have " + text_of(correspondence.camera));
  if (correspondence.projector != calibration.projector.size)
    return input_error("the calibration is for a projector of " + text_of(calibration.projector.size) +
                       " pixels, the capture is for " + text_of(correspondence.projector));

  const Size size = correspondence.camera;
  const Scene scene(calibration);
  PointGrid grid{Image<Point3f>(size), FloatImage(size)};
  const auto width = static_cast<std::size_t>(size.width);
  const std::vector<float> missing(width, none);
  const std::vector<float> unit(width, 1.0F);
  parallel_for(0, size.height, 16, [&](int first, int last) {
    std::vector<float> ray_x(width);
    std::vector<float> ray_y(width);
    std::vector<float> depth(width);
    for (int y = first; y < last; ++y) {
      const auto& rows = correspondence.rows;
      const auto& columns = correspondence.columns;
      const Measured measured{rows ? rows->coordinate.row(y) : missing.data(),
                              rows ? rows->sigma.row(y) : unit.data(),
                              columns ? columns->coordinate.row(y) : missing.data(),
                              columns ? columns->sigma.row(y) : unit.data()};
      const auto [begin, end] = measured_range(measured, size.width);
      run_kernel<Rays>(&scene.camera, y, begin, end, ray_x.data(), ray_y.data());
      run_kernel<Depths>(&scene, options, measured, begin, end, static_cast<const float*>(ray_x.data()),
                         static_cast<const float*>(ray_y.data()), depth.data(), grid.sigma_mm.row(y));
      Point3f* points = grid.points.row(y);
      std::fill(points, points + begin, Point3f{none, none, none});
      for (int x = begin; x < end; ++x) points[x] = {ray_x[x] * depth[x], ray_y[x] * depth[x], depth[x]};
      std::fill(points + end, points + size.width, Point3f{none, none, none});
    }
  });
  return grid;
}

}  // namespace bodyscan
