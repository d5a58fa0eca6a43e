#pragma once

#include "app/scan/scan.hpp"
#include "hal/camera.hpp"
#include "hal/projector.hpp"
#include "pipeline/geometry/calibration.hpp"

#include <deque>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace bodyscan {

// A camera of 320 x 240 pixels and a projector of 64 x 48, 270 mm below it.
Calibration world_calibration();

// White, black, six bits of rows with their inverses, white.
inline constexpr int world_patterns = 15;

// The distance of a point from the tilted plane that is photographed while it is where it began, mm.
double distance_to_subject_mm(const Point3f& point);

// Shows what it is told and fails on demand. Flips and openings count from 0.
class FakeProjector : public Projector {
 public:
  int gone_at_flip = -1;                  // that one fails, and all until it is opened again
  int failing_opens = 0;                  // after it was gone
  std::string reason = "HDMI-A-1: gone";  // why opening fails
  std::function<void(int)> on_flip;       // told each that succeeds

  Expected<void> open() override;
  [[nodiscard]] DisplayMode mode() const override { return {world_calibration().projector.size, 60}; }
  Expected<std::int64_t> show(const GrayImage8& picture) override;
  void close() override;

  // Black where it is closed or gone.
  [[nodiscard]] GrayImage8 shown();
  [[nodiscard]] bool lit();
  [[nodiscard]] bool is_open();
  [[nodiscard]] int flips();
  [[nodiscard]] int lit_flips();
  [[nodiscard]] int opens();

 private:
  std::mutex mutex_;
  GrayImage8 shown_;
  bool open_ = false;
  bool gone_ = false;
  int flips_ = 0;
  int lit_flips_ = 0;
  int opens_ = 0;
};

// Photographs a tilted plane with a texture. Shots count from 0, those that failed or are thrown away too.
class FakeCamera : public Camera {
 public:
  explicit FakeCamera(FakeProjector& projector) : projector_(projector) {}

  std::vector<int> failing_exposures;
  std::vector<int> failing_fetches;
  int failing_opens = 0;  // after the first
  std::string problem;
  std::vector<int> stale_shots;  // deliver the picture of the shot before; their own is lost
  int out_of_step_from = -1;     // from then on each delivers the picture of the shot before
  std::vector<int> overexposed_shots;
  std::function<double(int)> moved_mm;  // where the subject is at a shot
  std::optional<Size> picture;          // another than the calibration's

  Expected<CameraIdentity> open() override;
  Expected<CameraSettings> configure(const CameraSettings& wanted) override { return wanted; }
  Expected<void> expose() override;
  Expected<Photograph> fetch() override;
  Expected<Photograph> preview() override { return device_error("no preview"); }
  void close() override;

  [[nodiscard]] bool is_open() const { return open_; }
  [[nodiscard]] int shots() const { return shots_; }
  [[nodiscard]] int opens() const { return opens_; }

 private:
  [[nodiscard]] Photograph photograph(int shot);

  FakeProjector& projector_;
  bool open_ = false;
  int opens_ = 0;
  int shots_ = 0;
  std::deque<Photograph> memory_;
  Photograph last_;
  unsigned noise_ = 12345;
};

// A station in a folder, its options, and what came out of a scan.
class World {
 public:
  explicit World(const std::filesystem::path& folder);

  Expected<ScanReport> scan();

  FakeProjector projector;
  FakeCamera camera{projector};
  std::function<Expected<void>()> stop = [] { return Expected<void>(); };
  ScanOptions options;
  Patience patience{.retry_every_ms = 10, .give_up_after_ms = 150};
};

}  // namespace bodyscan
