#include "tools/simulator/tracer.hpp"

#include "tools/simulator/shapes.hpp"
#include "tools/simulator/skin.hpp"

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace bodyscan::simulator {
namespace {

using Eigen::Vector3d;

Scene empty_scene() {
  Scene scene;
  scene.calibration =
      make_rig({.name = "rows", .scale = 0.125, .projector = {1024, 768}, .projector_roll = 0}).value();
  return scene;
}

Scene tilted_plate() {
  Scene scene = empty_scene();
  append_rectangle(scene.subject.mesh, Vector3d(10, -20, 1060), Vector3d(150, 10, 30),
                   Vector3d(-10, 120, 25));
  return scene;
}

TEST(Tracer, FindsAPlaneToAMicrometre) {
  const Scene scene = tilted_plate();
  const Tracer tracer = Tracer::make(scene).value();
  const Vector3d normal = Vector3d(-10, 120, 25).cross(Vector3d(150, 10, 30)).normalized();
  for (double x = -0.1; x <= 0.1; x += 0.013) {
    for (double y = -0.08; y <= 0.08; y += 0.011) {
      const Vector3d direction(x, y, 1);
      const auto hit = tracer.hit(direction, Vector3d::Zero());
      ASSERT_TRUE(hit);
      EXPECT_NEAR(hit->point.z(), normal.dot(Vector3d(10, -20, 1060)) / normal.dot(direction), 1e-9);
      EXPECT_LT((hit->point - hit->point.z() * direction).norm(), 1e-9);
      EXPECT_LT((hit->normal - normal).norm(), 1e-6);
      EXPECT_FLOAT_EQ(hit->albedo.y(), matt_albedo);
    }
  }
  EXPECT_FALSE(tracer.hit(Vector3d(0.4, 0, 1), Vector3d::Zero()));
}

TEST(Tracer, FindsASphereWithinItsTriangles) {
  Scene scene = empty_scene();
  const SphereFact sphere{Vector3d(12, 5, 1040), 30};
  append_sphere(scene.subject.mesh, sphere, 0.3);
  const Tracer tracer = Tracer::make(scene).value();
  for (double angle = 0; angle < 6.28; angle += 0.1) {
    const Vector3d aim = sphere.center + 25 * Vector3d(std::cos(angle), std::sin(angle), 0);
    const auto hit = tracer.hit(aim / aim.z(), Vector3d::Zero());
    ASSERT_TRUE(hit);
    const Vector3d outwards = hit->point - sphere.center;
    EXPECT_NEAR(outwards.norm(), 30, 0.001);
    EXPECT_LT((hit->normal - outwards.normalized()).norm(), 1e-3);
  }
}

TEST(Tracer, ProjectorCoordinatesAreTheLensProjection) {
  const Scene scene = tilted_plate();
  const Tracer tracer = Tracer::make(scene).value();
  const auto hit = tracer.hit(Vector3d(0.05, -0.03, 1), Vector3d::Zero()).value();
  const Illumination light = tracer.illumination(hit, Vector3d::Zero());
  const Eigen::Vector2d pixel =
      scene.calibration.projector.project(scene.calibration.projector_from_camera * hit.point);
  EXPECT_TRUE(light.in_picture);
  EXPECT_TRUE(light.direct);
  EXPECT_NEAR(light.column, pixel.x(), 1e-9);
  EXPECT_NEAR(light.row, pixel.y(), 1e-9);
  EXPECT_NEAR(light.distance, (hit.point - Vector3d(0, 268, 0)).norm(), 1e-6);
  EXPECT_NEAR(light.cosine, hit.normal.dot((Vector3d(0, 268, 0) - hit.point).normalized()), 1e-9);
}

TEST(Tracer, ASurfaceOutsideThePictureOrTurnedAwayGetsNoDirectLight) {
  Scene scene = empty_scene();
  append_rectangle(scene.subject.mesh, Vector3d(0, 0, 1050), Vector3d(2000, 0, 0), Vector3d(0, 2000, 0));
  // Faces the camera from above, but the projector below sees its back.
  append_rectangle(scene.subject.mesh, Vector3d(0, 100, 900), Vector3d(40, 0, 0), Vector3d(0, -3, -40));
  const Tracer tracer = Tracer::make(scene).value();
  const auto far = tracer.hit(Vector3d(0.6, 0, 1), Vector3d::Zero()).value();
  EXPECT_FALSE(tracer.illumination(far, Vector3d::Zero()).in_picture);
  EXPECT_FALSE(tracer.illumination(far, Vector3d::Zero()).direct);
  const auto turned = tracer.hit(Vector3d(0, 100.0 / 900, 1), Vector3d::Zero()).value();
  EXPECT_NEAR(turned.point.z(), 900, 1);
  EXPECT_TRUE(tracer.illumination(turned, Vector3d::Zero()).in_picture);
  EXPECT_FALSE(tracer.illumination(turned, Vector3d::Zero()).direct);
}

TEST(Tracer, AnObstacleCastsItsShadowWhereTheProjectorLosesSight) {
  Scene scene = empty_scene();
  append_rectangle(scene.subject.mesh, Vector3d(0, 0, 1050), Vector3d(200, 0, 0), Vector3d(0, 200, 0));
  append_rectangle(scene.subject.mesh, Vector3d(0, 0, 950), Vector3d(20, 0, 0), Vector3d(0, 20, 0));
  const Tracer tracer = Tracer::make(scene).value();
  const Vector3d projector(0, 268, 0);
  for (double y = -150; y <= 150; y += 7) {
    const Vector3d point(5, y, 1050);
    const double at_obstacle = projector.y() + (y - projector.y()) * 950 / 1050;
    const auto hit = tracer.hit(point / 1050, Vector3d::Zero()).value();
    if (hit.point.z() < 1000) continue;
    EXPECT_EQ(tracer.illumination(hit, Vector3d::Zero()).direct, std::abs(at_obstacle) > 20) << y;
  }
}

TEST(Tracer, AnOffsetMovesTheSubject) {
  const Scene scene = tilted_plate();
  const Tracer tracer = Tracer::make(scene).value();
  const Vector3d offset(3, -4, 12.5);
  const Vector3d point = tracer.hit(Vector3d(0.01, 0.02, 1), Vector3d::Zero())->point + offset;
  const auto hit = tracer.hit(point / point.z(), offset);
  ASSERT_TRUE(hit);
  EXPECT_LT((hit->point - point).norm(), 1e-9);
  EXPECT_TRUE(tracer.illumination(*hit, offset).direct);
}

TEST(Tracer, InterpolatesVertexColoursAndTextures) {
  Scene scene = empty_scene();
  TriangleMesh& mesh = scene.subject.mesh;
  append_rectangle(mesh, Vector3d(0, 0, 1000), Vector3d(100, 0, 0), Vector3d(0, 100, 0));
  mesh.albedo = {{0.2F, 0, 0}, {0.2F, 0, 0}, {0.6F, 0, 0}, {0.6F, 0, 0}};
  {
    const Tracer tracer = Tracer::make(scene).value();
    EXPECT_NEAR(tracer.hit(Vector3d(0.05, 0.02, 1), Vector3d::Zero())->albedo.x(), 0.5, 1e-5);
  }
  mesh.texture_at = {{0, 1}, {0, 0}, {1, 0}, {1, 1}};  // v points up, the camera's y down
  mesh.textures_of = {0, 0};
  ColorImage8 texture({2, 2}, Rgb8{0, 0, 0});
  texture(1, 0) = {255, 255, 255};
  mesh.textures.push_back(std::move(texture));
  const Tracer tracer = Tracer::make(scene).value();
  EXPECT_NEAR(tracer.hit(Vector3d(0.05, -0.05, 1), Vector3d::Zero())->albedo.y(), 1, 1e-5);
  EXPECT_NEAR(tracer.hit(Vector3d(-0.05, -0.05, 1), Vector3d::Zero())->albedo.y(), 0, 1e-5);
  EXPECT_NEAR(tracer.hit(Vector3d(0.05, 0.05, 1), Vector3d::Zero())->albedo.y(), 0, 1e-5);
}

}  // namespace
}  // namespace bodyscan::simulator
