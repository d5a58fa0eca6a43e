#include "tools/simulator/tracer.hpp"

#include "tools/simulator/sensor.hpp"
#include "tools/simulator/skin.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <Eigen/Geometry>
#include <embree3/rtcore.h>

namespace bodyscan::simulator {

using Eigen::Vector3d;
using Eigen::Vector3f;

struct Tracer::Embree {
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene scene = nullptr;

  Embree() = default;
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;
  ~Embree() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }

  bool build(const TriangleMesh& mesh) {
    if (device == nullptr) return false;
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.points.size()));
    auto* triangles = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Triangle), mesh.triangles.size()));
    if (points == nullptr || triangles == nullptr) {
      rtcReleaseGeometry(geometry);
      return false;
    }
    for (const Vector3d& point : mesh.points) {
      for (int k = 0; k < 3; ++k) *points++ = static_cast<float>(point[k]);
    }
    std::memcpy(triangles, mesh.triangles.data(), mesh.triangles.size() * sizeof(Triangle));
    rtcCommitGeometry(geometry);
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    return rtcGetDeviceError(device) == RTC_ERROR_NONE;
  }
};

namespace {

void set_ray(RTCRay& ray, const Vector3d& origin, const Vector3d& direction, float near, float far) {
  ray.org_x = static_cast<float>(origin.x());
  ray.org_y = static_cast<float>(origin.y());
  ray.org_z = static_cast<float>(origin.z());
  ray.dir_x = static_cast<float>(direction.x());
  ray.dir_y = static_cast<float>(direction.y());
  ray.dir_z = static_cast<float>(direction.z());
  ray.tnear = near;
  ray.tfar = far;
  ray.time = 0;
  ray.mask = ~0U;
  ray.id = 0;
  ray.flags = 0;
}

Vector3f texel(const ColorImage8& image, int x, int y) {
  static const std::array<float, 256> linear = [] {
    std::array<float, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i)
      table[i] = static_cast<float>(srgb_to_linear(static_cast<double>(i) / 255));
    return table;
  }();
  const auto wrapped = [](int i, int n) { return (i % n + n) % n; };
  const Rgb8& code = image(wrapped(x, image.width()), wrapped(y, image.height()));
  return {linear[code[0]], linear[code[1]], linear[code[2]]};
}

// Bilinear, repeating beyond 0..1.
Vector3f sample(const ColorImage8& image, const Eigen::Vector2d& at) {
  const double x = (at.x() - std::floor(at.x())) * image.width() - 0.5;
  const double y = (1 - (at.y() - std::floor(at.y()))) * image.height() - 0.5;
  const int column = static_cast<int>(std::floor(x));
  const int row = static_cast<int>(std::floor(y));
  const auto tx = static_cast<float>(x - column);
  const auto ty = static_cast<float>(y - row);
  return (1 - ty) * ((1 - tx) * texel(image, column, row) + tx * texel(image, column + 1, row)) +
         ty * ((1 - tx) * texel(image, column, row + 1) + tx * texel(image, column + 1, row + 1));
}

double largest_picture_tangent2(const Lens& lens) {
  double largest = 0;
  for (const double x : {0.0, 0.5, 1.0}) {
    for (const double y : {0.0, 0.5, 1.0})
      largest =
          std::max(largest, lens.ray({x * lens.size.width, y * lens.size.height}).head<2>().squaredNorm());
  }
  return 1.2 * largest;
}

}  // namespace

Tracer::Tracer(const Scene& scene)
    : scene_(&scene),
      embree_(std::make_shared<Embree>()),
      largest_tangent2_(largest_picture_tangent2(scene.calibration.projector)) {
  const RigidTransform& transform = scene.calibration.projector_from_camera;
  projector_center_ = -(transform.rotation.transpose() * transform.translation);
}

Expected<Tracer> Tracer::make(const Scene& scene) {
  Tracer tracer(scene);
  if (!tracer.embree_->build(scene.subject.mesh))
    return input_error("--subject: Embree cannot hold the mesh");
  return tracer;
}

std::optional<SurfaceHit> Tracer::hit(const Vector3d& direction, const Vector3d& offset) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query;
  set_ray(query.ray, -offset, direction, 1, 1e6F);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(embree_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;

  const TriangleMesh& mesh = scene_->subject.mesh;
  const Triangle& triangle = mesh.triangles[query.hit.primID];
  const Vector3d a = mesh.points[triangle[0]] + offset;
  const Vector3d ab = mesh.points[triangle[1]] + offset - a;
  const Vector3d ac = mesh.points[triangle[2]] + offset - a;
  const Vector3d cross = ab.cross(ac);
  const double slope = cross.dot(direction);
  if (slope == 0) return std::nullopt;
  SurfaceHit hit;
  hit.point = direction * (cross.dot(a) / slope);
  const double side = slope > 0 ? -1 : 1;
  hit.face_normal = side * cross.normalized();

  const Vector3d from_a = hit.point - a;
  const double scale = 1 / cross.squaredNorm();
  const double to_b = from_a.cross(ac).dot(cross) * scale;
  const double to_c = ab.cross(from_a).dot(cross) * scale;
  const Vector3d weights(1 - to_b - to_c, to_b, to_c);
  Vector3d normal = Vector3d::Zero();
  if (!mesh.normals.empty()) {
    for (int k = 0; k < 3; ++k)
      normal += weights[k] * mesh.normals[triangle[static_cast<std::size_t>(k)]].cast<double>();
  }
  const bool smooth = normal.squaredNorm() > 0.25;
  hit.normal = smooth ? Vector3d(side * normal.normalized()) : hit.face_normal;
  hit.albedo = albedo(query.hit.primID, weights, hit.point - offset);
  return hit;
}

Vector3f Tracer::albedo(unsigned triangle, const Vector3d& weights, const Vector3d& point) const {
  const Subject& subject = scene_->subject;
  const TriangleMesh& mesh = subject.mesh;
  if (subject.material == Material::skin)
    return skin_albedo(scene_->subject_point(point), scene_->moles_in_subject);
  if (subject.material == Material::printed)
    return Vector3f::Constant(subject.sheet->albedo(subject.sheet->paper(scene_->subject_point(point))));
  const Triangle& corners = mesh.triangles[triangle];
  const Vector3f w = weights.cast<float>();
  if (!mesh.textures_of.empty() && mesh.textures_of[triangle] >= 0) {
    const Eigen::Vector2f at = w[0] * mesh.texture_at[corners[0]] + w[1] * mesh.texture_at[corners[1]] +
                               w[2] * mesh.texture_at[corners[2]];
    return sample(mesh.textures[static_cast<std::size_t>(mesh.textures_of[triangle])], at.cast<double>());
  }
  if (mesh.albedo.empty()) return Vector3f::Constant(matt_albedo);
  return w[0] * mesh.albedo[corners[0]] + w[1] * mesh.albedo[corners[1]] + w[2] * mesh.albedo[corners[2]];
}

bool Tracer::occluded(const Vector3d& point, const Vector3d& target) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray;
  set_ray(ray, point, target - point, 0, 1);
  rtcOccluded1(embree_->scene, &context, &ray);
  return ray.tfar < 0;
}

Illumination Tracer::illumination(const SurfaceHit& hit, const Vector3d& offset) const {
  Illumination light;
  const Vector3d to_projector = projector_center_ - hit.point;
  light.distance = to_projector.norm();
  light.cosine = hit.normal.dot(to_projector) / light.distance;
  const Vector3d seen = scene_->calibration.projector_from_camera * hit.point;
  const Lens& lens = scene_->calibration.projector;
  if (seen.z() <= 0 || seen.head<2>().squaredNorm() > largest_tangent2_ * seen.z() * seen.z()) return light;
  const Eigen::Vector2d pixel = lens.project(seen);
  light.column = pixel.x();
  light.row = pixel.y();
  light.in_picture = pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() <= lens.size.width - 0.5 &&
                     pixel.y() <= lens.size.height - 0.5;
  const bool faces = light.cosine > 0 && hit.face_normal.dot(to_projector) > 0;
  constexpr double lift = 0.005;  // mm off the surface, so that a triangle does not shade itself
  light.direct = light.in_picture && faces &&
                 !occluded(hit.point + lift * hit.face_normal - offset, projector_center_ - offset);
  return light;
}

}  // namespace bodyscan::simulator
