#include "tools/simulator/shapes.hpp"
#include "tools/simulator/skin.hpp"
#include "tools/simulator/subjects.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include <Eigen/Geometry>

namespace bodyscan::simulator {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr double degrees = pi / 180;

double bell(double distance, double width) {
  return std::exp(-distance * distance / (2 * width * width));
}
double bell(double x, double x_width, double y, double y_width) {
  return bell(x, x_width) * bell(y, y_width);
}
double ramp(double x, double from, double to) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// Parallel furrows `depth` mm deep, one every `spacing` mm, each about a third of that wide.
double furrows(double across, double spacing, double depth) {
  return -depth * std::pow(0.5 + 0.5 * std::cos(2 * pi * across / spacing), 4);
}

double pores(const Vector3d& at) {
  return 0.03 * smooth_noise(at / 2.5) + 0.08 * smooth_noise(at / 7.0);
}

// Angles around an upright body, descending by 2 pi; the front (u = pi / 2) is fine, the back coarse.
std::vector<double> around(double fine, double coarse) {
  std::vector<double> angles = even_steps(1.94 * pi, 1.06 * pi, coarse);
  const std::vector<double> front = even_steps(1.06 * pi, -0.06 * pi, fine);
  angles.insert(angles.end(), front.begin() + 1, front.end());
  return angles;
}

void add_moles(Subject& subject, const Surface& surface, const std::vector<Vector3d>& u_v_diameter) {
  for (const Vector3d& mole : u_v_diameter)
    subject.facts.moles.push_back({surface(mole.x() * degrees, mole.y()), mole.z()});
}

double face_relief(double x, double y) {
  const double side = std::abs(x);
  double relief = 20 * bell(x, 8, y - 15, y < 15 ? 13 : 5.5) + 8 * bell(x, 7.5, y + 8, 14);  // nose
  relief += 6 * bell(side - 12, 4.5, y - 19, 5);                                             // its wings
  relief += -8 * bell(side - 31, 14, y + 21, 9) + 6 * bell(side - 31, 9, y + 20, 7);         // eyes
  relief += 4 * bell(x, 38, y + 40, 7) + 4 * bell(side - 41, 16, y - 12, 15);                // brow, cheeks
  relief += 4 * bell(x, 17, y - 48, 3.5) + 4.5 * bell(x, 15, y - 58, 4.5);                   // lips
  relief += -3 * bell(x, 19, y - 53, 1.6) + 7 * bell(x, 17, y - 82, 12);                     // mouth, chin
  return relief;
}

Vector3d head_surface(double u, double v) {
  const Vector3d direction(std::sin(v) * std::cos(u), -std::cos(v), -std::sin(v) * std::sin(u));
  const double skull = 1 / direction.cwiseQuotient(Vector3d(76, 118, 96)).norm();
  const double across = std::max(1e-3, std::abs(std::sin(v)));
  const double neck_side = 52 / across;
  const double neck_end = 190 / std::max(1e-3, direction.y());
  const double neck =
      ramp(direction.y(), 0, 0.3) * std::pow(std::pow(neck_side, -12) + std::pow(neck_end, -12), -1.0 / 12);
  const double radius = std::pow(std::pow(skull, 12) + std::pow(neck, 12), 1.0 / 12);
  const Vector3d base = radius * direction;
  double relief = 0;
  const double front = ramp(-direction.z(), 0.05, 0.35);
  if (front > 0) {
    relief += front * face_relief(base.x(), base.y());
    const double forehead = bell(base.x(), 30) * ramp(base.y(), -92, -80) * ramp(-base.y(), 50, 60);
    relief += forehead * furrows(base.y() + 2 * std::cos(base.x() / 12), 7, 0.2);
    const double corner_x = std::abs(base.x()) - 44;
    const double corner = front * bell(corner_x - 9, 5, base.y() + 20, 9) * ramp(corner_x, 0, 4);
    relief += corner * furrows(std::atan2(base.y() + 20, corner_x + 4) * 12, 3.2, 0.2);
  }
  relief += 15 * bell(base.y() + 5, 17, direction.z() * 80 + 2, 6) * ramp(std::abs(direction.x()), 0.7, 0.95);
  return base + (relief + pores(base)) * direction + Vector3d(0, -30, 75);
}

Vector3d torso_surface(double u, double y) {
  const double waist = bell(y - 95, 70);
  const double half_width = 172 - 26 * waist - 20 * ramp(-y, 150, 290);
  const double half_depth = 108 - 14 * waist;
  // A superellipse: flatter in front than an ellipse.
  const double c = std::cos(u);
  const double s = std::sin(u);
  const double round = std::pow(std::pow(std::abs(c), 2.4) + std::pow(std::abs(s), 2.4), -1 / 2.4);
  const Vector3d base(half_width * round * c, y, -half_depth * round * s);
  const Vector3d outwards = Vector3d(c / half_width, 0, -s / half_depth).normalized();
  const double x = base.x();
  const double side = std::abs(x);
  double relief = 0;
  if (s > 0) {
    relief += 16 * bell(side - 72, 42, y + 78, 46) - 4 * bell(x, 11, y + 80, 70);  // breast, sternum
    relief += 3.5 * bell(side - 85, 5, y + 62, 5);                                 // nipples
    relief +=
        5 * bell(y + 168 + 0.12 * side, 8) * ramp(side, 12, 35) * ramp(-side, -150, -120);  // collar bones
    relief += -2.5 * bell(x, 7) * ramp(y, -20, 10) - 9 * bell(x, 8, y - 108, 7);  // middle line, navel
    relief += 1.5 * std::cos((y + 0.25 * side) * 2 * pi / 26) * bell(side - 95, 32, y - 20, 38);  // ribs
    relief += bell(x, 70, y - 150, 16) * furrows(y + 3 * std::cos(x / 25), 9, 0.2);               // creases
    relief *= ramp(s, 0, 0.15);
  }
  return base + (relief + pores(base)) * outwards + Vector3d(0, 0, 95);
}

// A rounded tube along its local +y, ends included.
struct Limb {
  double radius = 0;
  double half_length = 0;                                              // ends included
  double flatness = 1;                                                 // depth over width
  std::function<double(double t)> taper = [](double) { return 1.0; };  // t from -1 to 1
  std::function<double(double u, double y)> relief = [](double, double) { return 0.0; };
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Vector3d center = Vector3d::Zero();

  [[nodiscard]] double arc_length() const { return pi * radius + 2 * (half_length - radius); }

  // `s` runs along the meridian from one end to the other.
  [[nodiscard]] Vector3d at(double u, double s) const {
    const double cap = pi * radius / 2;
    const double straight = 2 * (half_length - radius);
    double r = radius;
    double y = s - cap - straight / 2;
    if (s < cap) {
      r = radius * std::sin(s / radius);
      y = -half_length + radius * (1 - std::cos(s / radius));
    } else if (s > cap + straight) {
      const double rest = (arc_length() - s) / radius;
      r = radius * std::sin(rest);
      y = half_length - radius * (1 - std::cos(rest));
    }
    const Vector3d base(r * taper(y / half_length) * std::cos(u), y,
                        -r * taper(y / half_length) * flatness * std::sin(u));
    const Vector3d outwards(std::cos(u) * r / radius, 0, -std::sin(u) * r / radius);
    return rotation * (base + (relief(u, y) + pores(base + center)) * outwards) + center;
  }
};

Surface append_limb(Subject& subject, const Limb& limb, double detail) {
  Surface surface = [limb](double u, double s) { return limb.at(u, s); };
  append_surface(subject.mesh, surface, around(detail / limb.radius, 3 / limb.radius),
                 even_steps(0, limb.arc_length(), detail));
  return surface;
}

// Local +y turned to the direction `angle` degrees below the camera's x axis.
Eigen::Matrix3d pointing(double angle) {
  return Eigen::AngleAxisd((angle - 90) * degrees, Vector3d::UnitZ()).toRotationMatrix();
}

void append_finger(Subject& subject, const Vector3d& root, double angle, double radius, double half_length,
                   double detail) {
  Limb finger{.radius = radius, .half_length = half_length};
  finger.taper = [](double t) {
    return 1 - 0.1 * t + 0.07 * bell(t - 0.05, 0.09) + 0.06 * bell(t - 0.5, 0.07);
  };
  finger.relief = [half_length](double u, double y) {
    const double knuckle = bell(y / half_length - 0.05, 0.07) + bell(y / half_length - 0.5, 0.05);
    const double nail =
        bell(u - pi / 2, 0.5) * ramp(y / half_length, 0.68, 0.72) * ramp(-y / half_length, -0.95, -0.92);
    return knuckle * ramp(std::sin(u), 0, 0.5) * furrows(y, 2.4, 0.25) + 0.4 * nail;
  };
  finger.rotation = pointing(angle);
  finger.center = root + finger.rotation * Vector3d(0, half_length, 0);
  append_limb(subject, finger, std::min(detail, 0.4));
}

}  // namespace

Subject make_head(double detail) {
  Subject subject{.name = "head", .mesh = {}, .facts = {}, .material = Material::skin};
  append_surface(subject.mesh, head_surface, around(detail / 96, 3.0 / 96), even_steps(0, pi, detail / 118));
  Limb shoulders{.radius = 78, .half_length = 225, .flatness = 0.85};
  shoulders.rotation = pointing(0);
  shoulders.center = Vector3d(0, 205, 95);
  const Surface shoulder = append_limb(subject, shoulders, detail);
  add_moles(subject, head_surface,
            {{62, 1.70, 5},
             {118, 1.62, 3},
             {104, 1.0, 4},
             {75, 1.05, 2},
             {56, 2.05, 6},
             {128, 2.1, 2.5},
             {84, 2.45, 8}});
  add_moles(subject, shoulder, {{70, 210, 4}, {95, 330, 6}, {60, 400, 3}, {100, 160, 10}});
  return subject;
}

Subject make_torso(double detail) {
  Subject subject{.name = "torso", .mesh = {}, .facts = {}, .material = Material::skin};
  append_surface(subject.mesh, torso_surface, around(detail / 150, 4.0 / 150), even_steps(-300, 300, detail));
  add_moles(subject, torso_surface,
            {{110, -150, 3},
             {75, -120, 5},
             {96, -60, 2},
             {60, -20, 8},
             {120, 0, 4},
             {82, 40, 6},
             {101, 75, 3},
             {70, 110, 12},
             {115, 140, 5},
             {88, 170, 2},
             {65, 190, 4},
             {105, 205, 7},
             {85, -190, 3},
             {130, -90, 5}});
  return subject;
}

Subject make_forearm(double detail) {
  Subject subject{.name = "forearm", .mesh = {}, .facts = {}, .material = Material::skin};
  Limb arm{.radius = 46, .half_length = 190};
  arm.flatness = 0.85;
  arm.taper = [](double t) { return 0.98 - 0.34 * ramp(t, -0.6, 0.9) + 0.05 * bell(t + 0.35, 0.2); };
  arm.relief = [](double u, double y) {
    const double tendons = 1.2 * std::cos(6 * (u - pi / 2)) * bell(u - pi / 2, 0.5) * ramp(y, 0, 120);
    const double vein = 0.9 * bell((u - 1.2 - 0.15 * std::sin(y / 30)) * 40, 2.2) * bell(y - 20, 70);
    return tendons + vein + ramp(y, 135, 150) * ramp(-y, -175, -165) * furrows(y, 5, 0.2);
  };
  arm.rotation = pointing(3);
  arm.center = Vector3d(-150, -6, 30);
  const Surface arm_surface = append_limb(subject, arm, detail);

  Limb palm{.radius = 43, .half_length = 62, .flatness = 0.36};
  palm.relief = [](double u, double y) {
    const double across = std::cos(u);
    double knuckles = 0;
    for (const double at : {-0.66, -0.22, 0.22, 0.64}) knuckles += 4 * bell((across - at) * 43, 6, y - 40, 7);
    return ramp(std::sin(u), 0, 0.4) * knuckles;
  };
  palm.rotation = pointing(0);
  palm.center = Vector3d(70, 2, 24);
  const Surface palm_surface = append_limb(subject, palm, detail);

  append_finger(subject, Vector3d(108, -28, 23), -9, 8.5, 40, detail);
  append_finger(subject, Vector3d(112, -9, 22), -2, 9.2, 44, detail);
  append_finger(subject, Vector3d(112, 10, 22), 4, 8.8, 41, detail);
  append_finger(subject, Vector3d(106, 28, 24), 12, 7.4, 34, detail);
  append_finger(subject, Vector3d(45, -25, 20), -40, 10, 42, detail);
  add_moles(subject, arm_surface,
            {{80, 120, 4}, {100, 170, 6}, {70, 210, 2.5}, {95, 260, 8}, {110, 300, 3}, {85, 340, 5}});
  add_moles(subject, palm_surface, {{90, 60, 3}, {60, 80, 2}});
  return subject;
}

}  // namespace bodyscan::simulator
