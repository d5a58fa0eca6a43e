#pragma once

#include "pipeline/model/vrml_reader.hpp"
#include "tests/app/scan/world.hpp"

#include <cmath>
#include <cstddef>
#include <filesystem>

#include <gtest/gtest.h>

namespace bodyscan {

// How a model's points lie to the plane that was scanned.
struct MeasuredPlane {
  std::size_t points = 0;
  double rms_mm = 0;
  double mean_mm = 0;
};

inline MeasuredPlane measured_plane(const std::filesystem::path& model) {
  const Expected<VrmlModel> read = read_model(model);
  EXPECT_TRUE(read) << read.error().message;
  if (!read || read->mesh.points.empty()) return {};
  MeasuredPlane plane{read->mesh.points.size(), 0, 0};
  for (const Point3f& point : read->mesh.points) {
    const double distance = distance_to_subject_mm(point);
    plane.rms_mm += distance * distance;
    plane.mean_mm += distance;
  }
  const auto count = static_cast<double>(plane.points);
  plane.rms_mm = std::sqrt(plane.rms_mm / count);
  plane.mean_mm /= count;
  return plane;
}

}  // namespace bodyscan
