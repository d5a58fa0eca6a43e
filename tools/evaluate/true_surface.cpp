#include "tools/evaluate/true_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Geometry>
#include <embree3/rtcore.h>

namespace bodyscan {
namespace {

using Eigen::Vector3d;

// Ericson, Real-Time Collision Detection (2005), section 5.1.5.
Vector3d closest_on_triangle(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d ab = b - a;
  const Vector3d ac = c - a;
  const double d1 = ab.dot(p - a);
  const double d2 = ac.dot(p - a);
  if (d1 <= 0 && d2 <= 0) return a;
  const double d3 = ab.dot(p - b);
  const double d4 = ac.dot(p - b);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ab * (d1 / (d1 - d3));
  const double d5 = ab.dot(p - c);
  const double d6 = ac.dot(p - c);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ac * (d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  }
  return a + ab * (vb / (va + vb + vc)) + ac * (vc / (va + vb + vc));
}

struct Query {
  const Mesh* mesh;
  Vector3d point;
  double best;  // the distance to beat
  bool found = false;
  Vector3d offset = Vector3d::Zero();  // from the closest point to the query's
  Vector3d normal = Vector3d::Zero();
  Vector3d place = Vector3d::Zero();
};

Vector3d corner(const Mesh& mesh, std::uint32_t index) {
  const Point3f& point = mesh.points[index];
  return {point.x, point.y, point.z};
}

bool visit_triangle(RTCPointQueryFunctionArguments* arguments) {
  Query& query = *static_cast<Query*>(arguments->userPtr);
  const Face& face = query.mesh->faces[arguments->primID];
  const Vector3d a = corner(*query.mesh, face[0]);
  const Vector3d b = corner(*query.mesh, face[1]);
  const Vector3d c = corner(*query.mesh, face[2]);
  const Vector3d place = closest_on_triangle(query.point, a, b, c);
  const double distance = (query.point - place).norm();
  if (distance >= query.best) return false;
  query.best = distance;
  query.found = true;
  query.offset = query.point - place;
  query.place = place;
  query.normal = (b - a).cross(c - a);
  const float radius = static_cast<float>(distance + 1e-3);  // a few roundings at 1 m
  if (radius >= arguments->query->radius) return false;
  arguments->query->radius = radius;
  return true;
}

}  // namespace

struct TrueSurface::Scene {
  explicit Scene(Mesh surface) : mesh(std::move(surface)) {}
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;
  ~Scene() {
    if (handle) rtcReleaseScene(handle);
    if (device) rtcReleaseDevice(device);
  }

  Mesh mesh;
  RTCDevice device = nullptr;
  RTCScene handle = nullptr;
};

TrueSurface::TrueSurface(std::unique_ptr<Scene> scene) : scene_(std::move(scene)) {}
TrueSurface::TrueSurface(TrueSurface&&) noexcept = default;
TrueSurface& TrueSurface::operator=(TrueSurface&&) noexcept = default;
TrueSurface::~TrueSurface() = default;

Expected<TrueSurface> TrueSurface::build(Mesh mesh) {
  if (mesh.faces.empty()) return input_error("the true mesh has no faces");
  auto scene = std::make_unique<Scene>(std::move(mesh));
  scene->device = rtcNewDevice(nullptr);
  if (!scene->device) return input_error("Embree cannot start");
  scene->handle = rtcNewScene(scene->device);
  rtcSetSceneFlags(scene->handle, RTC_SCENE_FLAG_ROBUST);
  const RTCGeometry geometry = rtcNewGeometry(scene->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  const Mesh& held = scene->mesh;
  // Embree reads 16 bytes at the last vertex, so it gets a buffer of its own.
  auto* vertices = static_cast<Point3f*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Point3f), held.points.size()));
  auto* indices = static_cast<Face*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Face), held.faces.size()));
  if (!vertices || !indices) {
    rtcReleaseGeometry(geometry);
    return input_error("the true mesh does not fit into memory");
  }
  std::ranges::copy(held.points, vertices);
  std::ranges::copy(held.faces, indices);
  rtcSetGeometryPointQueryFunction(geometry, visit_triangle);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene->handle, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene->handle);
  if (rtcGetDeviceError(scene->device) != RTC_ERROR_NONE) return input_error("Embree refuses the true mesh");
  return TrueSurface(std::move(scene));
}

double TrueSurface::signed_distance(const Vector3d& point, double at_most) const {
  Query query{.mesh = &scene_->mesh, .point = point, .best = at_most};
  const Eigen::Vector3f place = point.cast<float>();
  RTCPointQuery volume{};
  volume.x = place.x();
  volume.y = place.y();
  volume.z = place.z();
  volume.radius = static_cast<float>(at_most);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(scene_->handle, &volume, &context, nullptr, &query);
  if (!query.found) return std::numeric_limits<double>::infinity();
  const Vector3d toward_camera = query.normal.dot(query.place) > 0 ? Vector3d(-query.normal) : query.normal;
  return query.offset.dot(toward_camera) < 0 ? -query.best : query.best;
}

}  // namespace bodyscan
