#include "tests/app/scan/world.hpp"

#include "hal/clock.hpp"
#include "pipeline/calibration/calibration_file.hpp"
#include "pipeline/image/codec.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

constexpr double plane_mm = 1000;
constexpr double tilt = 0.15;  // mm of depth a mm to the right
constexpr int light_levels = 4096;

// What a camera pixel sees: brightness of the subject, and where on the projector's picture that lies.
struct Sight {
  float reflectance = 0;
  float column = 0;
  float row = 0;
};

std::vector<Sight> sights(double moved_mm) {
  const Calibration calibration = world_calibration();
  const Size size = calibration.camera.size;
  std::vector<Sight> all;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const Eigen::Vector3d ray = calibration.camera.ray({x, y});
      const Eigen::Vector3d point = ray * (plane_mm - tilt * moved_mm) / (1 - tilt * ray.x());
      const Eigen::Vector2d at = calibration.projector.project(calibration.projector_from_camera * point);
      const double texture =
          0.6 + 0.12 * std::sin((point.x() - moved_mm) / 11) + 0.1 * std::sin(point.y() / 13);
      all.push_back({static_cast<float>(texture), static_cast<float>(at.x()), static_cast<float>(at.y())});
    }
  }
  return all;
}

// The picture's brightness at a place, edges blurred over one of its pixels.
float shown_at(const GrayImage8& picture, float column, float row) {
  const int x = static_cast<int>(std::lround(column));
  if (x < 0 || x >= picture.width()) return 0;
  const auto whole = static_cast<int>(std::floor(row));
  const float share = row - static_cast<float>(whole);
  const auto of = [&](int y) {
    return y < 0 || y >= picture.height() ? 0.0F : static_cast<float>(picture(x, y)) / 255;
  };
  return (1 - share) * of(whole) + share * of(whole + 1);
}

const std::array<float, light_levels>& srgb() {
  static const std::array<float, light_levels> table = [] {
    std::array<float, light_levels> levels{};
    for (int i = 0; i < light_levels; ++i) {
      const double light = i / (light_levels - 1.0);
      levels.at(static_cast<std::size_t>(i)) = static_cast<float>(
          255 * (light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055));
    }
    return levels;
  }();
  return table;
}

bool is_lit(const GrayImage8& picture) {
  return std::ranges::any_of(picture.pixels(), [](std::uint8_t value) { return value != 0; });
}

bool holds(const std::vector<int>& shots, int shot) {
  return std::ranges::find(shots, shot) != shots.end();
}

}  // namespace

Calibration world_calibration() {
  Calibration calibration;
  calibration.camera = {.size = {320, 240}, .fx = 350, .fy = 350, .cx = 159.5, .cy = 119.5, .distortion = {}};
  calibration.projector = {.size = {64, 48}, .fx = 68, .fy = 68, .cx = 31.5, .cy = 41.5, .distortion = {}};
  calibration.projector_from_camera.translation = {0, -270, 0};
  return calibration;
}

double distance_to_subject_mm(const Point3f& point) {
  return (point.z - plane_mm - tilt * point.x) / std::sqrt(1 + tilt * tilt);
}

Expected<void> FakeProjector::open() {
  const std::lock_guard lock(mutex_);
  if (opens_ > 0 && failing_opens > 0) {
    --failing_opens;
    return device_error(reason);
  }
  ++opens_;
  open_ = true;
  gone_ = false;
  shown_ = GrayImage8(mode().size, 0);
  return {};
}

Expected<std::int64_t> FakeProjector::show(const GrayImage8& picture) {
  int flip = 0;
  {
    const std::lock_guard lock(mutex_);
    if (!open_) return device_error("projector: closed, needs open");
    flip = flips_++;
    gone_ = gone_ || flip == gone_at_flip;
    if (gone_) {
      shown_ = GrayImage8(mode().size, 0);
      return device_error("HDMI-A-1: gone");
    }
    shown_ = picture.clone();
    if (is_lit(picture)) ++lit_flips_;
  }
  if (on_flip) on_flip(flip);
  return monotonic_us();
}

void FakeProjector::close() {
  const std::lock_guard lock(mutex_);
  open_ = false;
}

GrayImage8 FakeProjector::shown() {
  const std::lock_guard lock(mutex_);
  return open_ ? shown_.clone() : GrayImage8(mode().size, 0);
}

bool FakeProjector::lit() {
  return is_lit(shown());
}

bool FakeProjector::is_open() {
  const std::lock_guard lock(mutex_);
  return open_;
}

int FakeProjector::flips() {
  const std::lock_guard lock(mutex_);
  return flips_;
}

int FakeProjector::lit_flips() {
  const std::lock_guard lock(mutex_);
  return lit_flips_;
}

int FakeProjector::opens() {
  const std::lock_guard lock(mutex_);
  return opens_;
}

Expected<CameraIdentity> FakeCamera::open() {
  if (opens_ > 0 && failing_opens > 0) {
    --failing_opens;
    return device_error("camera: nothing answers");
  }
  open_ = true;
  memory_.clear();
  if (opens_++ == 0 && out_of_step_from == 0) memory_.push_back(photograph(-1));
  CameraIdentity identity{"Fake", "0815", {}};
  if (!problem.empty()) identity.problems.push_back(problem);
  return identity;
}

Expected<void> FakeCamera::expose() {
  if (!open_) return device_error("camera: closed, needs open");
  const int shot = shots_++;
  if (holds(failing_exposures, shot)) return device_error("camera: no shutter");
  Photograph taken = photograph(shot);
  if (shot > 0 && shot == out_of_step_from) memory_.push_back(last_);
  if (holds(stale_shots, shot)) taken = last_;
  last_ = taken;
  memory_.push_back(std::move(taken));
  return {};
}

Expected<Photograph> FakeCamera::fetch() {
  if (!open_ || memory_.empty()) return device_error("camera: no picture to fetch");
  if (holds(failing_fetches, shots_ - 1)) {
    open_ = false;
    return device_error("camera: lost");
  }
  Photograph oldest = std::move(memory_.front());
  memory_.pop_front();
  return oldest;
}

void FakeCamera::close() {
  open_ = false;
  memory_.clear();
}

Photograph FakeCamera::photograph(int shot) {
  const double moved = moved_mm ? moved_mm(shot) : 0;
  static const std::vector<Sight> at_rest = sights(0);
  const std::vector<Sight> moved_sights = moved == 0 ? std::vector<Sight>() : sights(moved);
  const std::vector<Sight>& seen = moved == 0 ? at_rest : moved_sights;
  const GrayImage8 shown = projector_.shown();
  const float exposure = holds(overexposed_shots, shot) ? 8.0F : 0.8F;
  GrayImage8 image(world_calibration().camera.size);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const float light = 0.01F + shown_at(shown, seen[i].column, seen[i].row);
    const float level = std::clamp(exposure * seen[i].reflectance * light, 0.0F, 1.0F) * (light_levels - 1);
    noise_ = noise_ * 1664525U + 1013904223U;
    const float noise = static_cast<float>(noise_ >> 24) / 256 - 0.5F;  // grey levels
    image.pixels()[i] = static_cast<std::uint8_t>(
        std::lround(std::clamp(srgb().at(static_cast<std::size_t>(level)) + noise, 0.0F, 255.0F)));
  }
  Expected<std::vector<std::byte>> file = encode_png(picture ? GrayImage8(*picture, 100) : std::move(image));
  EXPECT_TRUE(file);
  return {std::move(*file), monotonic_us()};
}

World::World(const std::filesystem::path& folder) {
  EXPECT_TRUE(write_calibration(world_calibration(), folder / "calibration.yml"));
  std::filesystem::create_directories(folder / "results");
  options.rig.calibration = folder / "calibration.yml";
  options.rig.projector.settle_ms = 0;
  options.rig.camera.settings.exposure_us = 1000;
  options.model.path = folder / "results" / "model.wrl";
  options.model.report = folder / "results" / "report.json";
}

Expected<ScanReport> World::scan() {
  Progress progress;
  return bodyscan::scan(options, {camera, projector, stop, patience}, progress);
}

}  // namespace bodyscan
