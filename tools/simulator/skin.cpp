#include "tools/simulator/skin.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace bodyscan::simulator {
namespace {

double lattice_value(std::int64_t x, std::int64_t y, std::int64_t z) {
  auto h = static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15ULL ^
           static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4FULL ^
           static_cast<std::uint64_t>(z) * 0x165667B19E3779F9ULL;
  h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9ULL;
  h = (h ^ (h >> 27)) * 0x94D049BB133111EBULL;
  return static_cast<double>(h >> 40) * 0x1p-23 - 1;
}

double fade(double t) {
  return t * t * t * (t * (t * 6 - 15) + 10);
}

}  // namespace

double smooth_noise(const Eigen::Vector3d& at) {
  const Eigen::Vector3d cell = at.array().floor();
  const Eigen::Vector3d t = at - cell;
  const Eigen::Matrix<std::int64_t, 3, 1> c = cell.cast<std::int64_t>();
  const double fx = fade(t.x());
  const auto along_x = [&](int dy, int dz) {
    return std::lerp(lattice_value(c.x(), c.y() + dy, c.z() + dz),
                     lattice_value(c.x() + 1, c.y() + dy, c.z() + dz), fx);
  };
  const double fy = fade(t.y());
  return std::lerp(std::lerp(along_x(0, 0), along_x(1, 0), fy), std::lerp(along_x(0, 1), along_x(1, 1), fy),
                   fade(t.z()));
}

Eigen::Vector3f skin_albedo(const Eigen::Vector3d& point, const std::vector<MoleFact>& moles) {
  const Eigen::Vector3f base(0.72F, 0.48F, 0.38F);
  const Eigen::Vector3f mole(0.26F, 0.13F, 0.09F);
  constexpr double edge = 0.2;  // mm over which a mole's border fades
  const auto mottling = static_cast<float>(smooth_noise(point / 9.0) + 0.6 * smooth_noise(point / 2.7) +
                                           0.4 * smooth_noise(point / 0.9));
  // Blood varies in green and blue more than in red.
  Eigen::Vector3f albedo = base.array() * (1.0F + mottling * Eigen::Array3f(0.025F, 0.05F, 0.05F));
  for (const MoleFact& spot : moles) {
    const double radius = spot.diameter / 2;
    const double distance2 = (point - spot.center).squaredNorm();
    if (distance2 > (radius + edge) * (radius + edge)) continue;
    const double inside = std::clamp(0.5 + (radius - std::sqrt(distance2)) / edge, 0.0, 1.0);
    albedo += static_cast<float>(inside) * (mole - albedo);
  }
  return albedo;
}

}  // namespace bodyscan::simulator
