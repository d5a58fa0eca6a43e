#pragma once

#include "pipeline/geometry/lens.hpp"
#include "pipeline/geometry/rigid_transform.hpp"

namespace bodyscan {

struct Calibration {
  Lens camera;
  Lens projector;
  RigidTransform projector_from_camera;
};

}  // namespace bodyscan
