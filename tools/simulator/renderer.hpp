#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/base/image.hpp"
#include "pipeline/pattern/sequence.hpp"
#include "tools/simulator/blurred_row.hpp"
#include "tools/simulator/lens_blur.hpp"
#include "tools/simulator/projected_light.hpp"
#include "tools/simulator/scene.hpp"
#include "tools/simulator/tracer.hpp"

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace bodyscan::simulator {

// A pixel is reachable only if camera and projector see the surface at most this far from its normal.
inline constexpr double largest_incidence_degrees = 75;

// What a perfect reconstruction would find, on the camera's pixel grid, at each pixel's centre.
struct TruthMaps {
  FloatImage depth;               // z, mm in the camera frame; 0 where no surface
  Image<Eigen::Vector3f> normal;  // unit length, towards the camera; 0 where no surface
  FloatImage rows;                // projector px; NaN where no projector light falls directly
  FloatImage columns;
  // 255 where a decoder can be asked for an answer: all rays of the pixel and of its four neighbours meet one
  // surface without a jump (a pixel's rays within a quarter of its footprint of the tangent plane at its
  // centre, from pixel to pixel within a half, curvature apart), inside the picture, directly lit, and within
  // the largest incidence of camera and projector.
  GrayImage8 reachable;
};

// Renders what the camera sees of each projected picture. Light, per channel:
//   albedo * (direct * ((1 - s) p_sharp + s p_scattered) + reflection * mean(p) + ambient)
// with p the projected picture over its black level, s the channel's scattered share, and direct the cosine
// law over the squared distance, times the projector's unevenness. The lens blurs this light before the
// sensor.
class Renderer {
 public:
  // `scene` must outlive the renderer. Without motion the rays are cast here, once.
  static Expected<Renderer> make(const Scene& scene, const RenderOptions& options);

  // The truth for the first frame.
  [[nodiscard]] TruthMaps truth() const;
  // Frame `index` of a capture, showing `pattern` or `board`. May be called from several threads.
  [[nodiscard]] ColorImage8 frame(const Pattern& pattern, int index) const;
  [[nodiscard]] ColorImage8 frame(const ProjectedBoard& board, int index) const;
  // Frame `index` while the projector shows any picture of its size (linear light, 0 to 1), all light times
  // `gain` in the camera.
  [[nodiscard]] ColorImage8 frame(const FloatImage& shown, int index, float gain = 1) const;

 private:
  struct SubRay {
    float row;
    float column;
    float direct;                         // white light that falls in directly
    std::array<std::uint16_t, 3> albedo;  // of 65535
    std::uint16_t hit;
  };
  // The rays of every pixel, rays^2 a pixel, and for each picture row the pixels that meet the subject.
  struct Samples {
    std::vector<std::array<int, 2>> spans;
    Image<SubRay> rays;
  };
  // The part of the picture that light falls on.
  struct Lit {
    int left = 0;
    int top = 0;
    LightImage light;
  };

  Renderer(const Scene& scene, const RenderOptions& options, Tracer tracer);
  [[nodiscard]] double evenness(const Illumination& light) const;
  [[nodiscard]] Samples trace(const Eigen::Vector3d& offset) const;
  [[nodiscard]] SubRay trace_ray(const Eigen::Vector2d& pixel, const Eigen::Vector3d& offset) const;
  [[nodiscard]] ColorImage8 frame(const ProjectedLight& light, int index, float gain) const;
  // `shown` gives the projected light at a ray.
  template <class Shown>
  [[nodiscard]] ColorImage8 picture(const Shown& shown, float mean, int index, float gain = 1) const;
  template <class Shown>
  [[nodiscard]] Lit light(const Samples& samples, const Shown& shown, float mean, float gain) const;
  [[nodiscard]] Lit lit_part(const Samples& samples) const;
  [[nodiscard]] ColorImage8 expose(const Lit& lit, int index) const;
  [[nodiscard]] double scattered_blur() const;
  void truth_at(int x, int y, TruthMaps& maps) const;

  const Scene* scene_;
  RenderOptions options_;
  Tracer tracer_;
  double white_ = 0;  // direct light of a surface that faces the projector at the reference distance
  double reference_distance2_ = 0;
  std::array<float, 3> scattered_share_{};
  Samples still_;
};

}  // namespace bodyscan::simulator
