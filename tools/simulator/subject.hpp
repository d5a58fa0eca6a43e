#pragma once

#include "pipeline/base/image.hpp"
#include "tools/simulator/printed_sheet.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace bodyscan::simulator {

using Triangle = std::array<std::uint32_t, 3>;

// The surface that is rendered. Points and normals have one entry a vertex, mm; triangles are
// counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3f> normals;     // unit length; empty: every triangle is flat
  std::vector<Eigen::Vector3f> albedo;      // linear 0..1; empty: the subject's material
  std::vector<Eigen::Vector2f> texture_at;  // 0..1, v upwards; empty: no texture
  std::vector<Triangle> triangles;
  std::vector<std::int32_t> textures_of;  // a triangle's texture, -1 for none; empty: no texture
  std::vector<ColorImage8> textures;      // sRGB
};

// What is known exactly about a subject. Lengths in mm.
struct PlaneFact {
  std::string name;
  std::array<Eigen::Vector3d, 4> corners;  // in order around the rectangle
  Eigen::Vector3d normal;                  // outwards, unit length
  double height = 0;                       // over the subject's base
};
struct SphereFact {
  Eigen::Vector3d center;
  double radius = 0;
};
struct BumpFact {          // h(r) = height / 2 (1 + cos(2 pi r / diameter)) over its plane
  Eigen::Vector3d center;  // of the foot
  Eigen::Vector3d normal;
  double diameter = 0;
  double height = 0;
};
struct MoleFact {
  Eigen::Vector3d center;
  double diameter = 0;
};
struct Facts {
  std::vector<PlaneFact> planes;
  std::vector<SphereFact> spheres;
  std::vector<BumpFact> bumps;
  std::vector<MoleFact> moles;
};

enum class Material { matt, skin, printed };

// A subject in its own frame: axes as the camera's (x right, y down, z away from the camera), origin at the
// point that the pose turns about.
struct Subject {
  std::string name;
  TriangleMesh mesh;
  Facts facts;
  Material material = Material::matt;
  std::optional<PrintedSheet> sheet =
      std::nullopt;  // of a printed subject, whose frame is the sheet's board frame
};

}  // namespace bodyscan::simulator
