#pragma once

#include <memory>

#include <xf86drm.h>
#include <xf86drmMode.h>

namespace bodyscan {

template <auto free_answer>
struct FreeKmsAnswer {
  template <class Answer>
  void operator()(Answer* answer) const {
    free_answer(answer);
  }
};

// What libdrm answers, each freed by its own function; null where the kernel refused.
using KmsResources = std::unique_ptr<drmModeRes, FreeKmsAnswer<drmModeFreeResources>>;
using KmsConnector = std::unique_ptr<drmModeConnector, FreeKmsAnswer<drmModeFreeConnector>>;
using KmsCrtc = std::unique_ptr<drmModeCrtc, FreeKmsAnswer<drmModeFreeCrtc>>;
using KmsPlanes = std::unique_ptr<drmModePlaneRes, FreeKmsAnswer<drmModeFreePlaneResources>>;
using KmsPlane = std::unique_ptr<drmModePlane, FreeKmsAnswer<drmModeFreePlane>>;
using KmsObjectProperties =
    std::unique_ptr<drmModeObjectProperties, FreeKmsAnswer<drmModeFreeObjectProperties>>;
using KmsProperty = std::unique_ptr<drmModePropertyRes, FreeKmsAnswer<drmModeFreeProperty>>;
using KmsBlob = std::unique_ptr<drmModePropertyBlobRes, FreeKmsAnswer<drmModeFreePropertyBlob>>;

}  // namespace bodyscan
