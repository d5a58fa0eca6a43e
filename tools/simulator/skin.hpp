#pragma once

#include "tools/simulator/subject.hpp"

#include <vector>

#include <Eigen/Core>

namespace bodyscan::simulator {

// Reflectance of the white matt test surface.
inline constexpr float matt_albedo = 0.82F;

// Smooth value noise in -1..1 with a period of one unit between independent values.
double smooth_noise(const Eigen::Vector3d& at);

// Linear RGB albedo of skin at a point of the subject's own frame (mm): about (0.72, 0.48, 0.38) with
// mottling of some 8 %, darkened inside the moles.
Eigen::Vector3f skin_albedo(const Eigen::Vector3d& point, const std::vector<MoleFact>& moles);

}  // namespace bodyscan::simulator
