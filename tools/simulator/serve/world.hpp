#pragma once

#include "pipeline/base/error.hpp"
#include "tools/simulator/renderer.hpp"
#include "tools/simulator/serve/darkroom.hpp"
#include "tools/simulator/serve/wall_light.hpp"

#include <memory>
#include <vector>

namespace bodyscan::simulator {

// A subject before a rig, photographed under whatever light the projector throws on it.
class World {
 public:
  // The subject may stand displaced by any of `displacements` (mm along the camera's x).
  static Expected<std::unique_ptr<World>> make(const RenderOptions& options,
                                               const std::vector<double>& displacements);

  [[nodiscard]] Size camera_size() const { return places_.front().scene->calibration.camera.size; }
  [[nodiscard]] Size projector_size() const { return places_.front().scene->calibration.projector.size; }

  // With the light times `gain`. The noise is the same whenever the same light is photographed.
  [[nodiscard]] Photo photograph(const LightMix& light, double gain, double displacement) const;
  // A JPEG at most 640 px wide. Not to be called from two threads at once.
  [[nodiscard]] SharedBytes preview(const LightMix& light, double gain, double displacement);

 private:
  // The subject where it stands, and the camera that sees it.
  struct Place {
    double displacement = 0;
    std::unique_ptr<Scene> scene;
    Renderer renderer;
  };
  explicit World(const RenderOptions& options) : options_(options) {}
  static Expected<Place> place(const RenderOptions& options, double displacement, int most_width);

  RenderOptions options_;
  std::vector<Place> places_;       // undisplaced first
  std::unique_ptr<Place> preview_;  // made when first asked for
};

}  // namespace bodyscan::simulator
