#pragma once

#include "pipeline/base/image.hpp"
#include "tools/simulator/serve/moment.hpp"
#include "tools/simulator/serve/ptp/dataset.hpp"

#include <memory>
#include <optional>

namespace bodyscan::simulator {

using SharedBytes = std::shared_ptr<const ptp::Bytes>;

// A shot's light, for the darkroom to develop.
struct Exposure {
  int shot = 0;  // counted from 1
  Moment begin;
  Moment end;
  double gain = 1;          // brightness in relation to the scene's own
  double displacement = 0;  // of the subject, mm along the camera's x
};

// A picture as the camera delivers it.
struct Photo {
  SharedBytes jpeg;
  Size size;
  SharedBytes thumbnail;  // JPEG
  Size thumbnail_size;
};

// Makes a camera's pictures, at its own pace. One photo and one preview at a time.
class Darkroom {
 public:
  Darkroom() = default;
  Darkroom(const Darkroom&) = delete;
  Darkroom& operator=(const Darkroom&) = delete;
  virtual ~Darkroom() = default;

  // A shot's exposure begins.
  virtual void shutter_opened(int shot, Moment moment) = 0;
  // Starts to develop an exposure that has ended; an unfinished one is given up.
  virtual void develop(const Exposure& exposure) = 0;
  // The developed photo, once.
  virtual std::optional<Photo> take_photo() = 0;
  // Starts to develop a small picture of what is seen now.
  virtual void develop_preview(const Exposure& exposure) = 0;
  // The preview's JPEG, once; null where none is ready.
  virtual SharedBytes take_preview() = 0;
};

}  // namespace bodyscan::simulator
