#pragma once

#include "tools/simulator/serve/camera_settings.hpp"
#include "tools/simulator/serve/darkroom.hpp"
#include "tools/simulator/serve/faults.hpp"
#include "tools/simulator/serve/object_store.hpp"
#include "tools/simulator/serve/ptp/transaction.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace bodyscan::simulator {

// A Nikon D5000 as its initiator sees it. Its shutter:
//
//   idle --a capture operation--> exposing --exposure time--> developing --the darkroom's photo--> idle
//
// A capture while it is not idle is answered DeviceBusy; DeviceReady says busy while exposing only. The
// camera neither waits nor looks at a clock: it is told what time it is.
class Camera {
 public:
  // `darkroom` must outlive the camera; `picture` is the size of its photos.
  Camera(Size picture, Faults faults, Darkroom& darkroom);

  // A new initiator has come: no session is open, the shutter is idle, a frozen camera wakes. False: it is
  // frozen for good.
  bool connect();
  // The answer to an operation; nothing from a frozen camera.
  std::optional<ptp::Response> execute(const ptp::Request& request, Moment now);
  // Does what has become due; call it when next_due has come and when the darkroom has finished something.
  void advance(Moment now);
  [[nodiscard]] std::optional<Moment> next_due() const;

  // Events for the event connection. Those in RAM are asked for by the initiator (Nikon's GetEvent).
  std::vector<ptp::Event> take_events();
  // Whether the camera drops its connections now; tells once.
  bool take_disconnection();

 private:
  enum class Shutter { idle, exposing, developing };
  enum class Target { card, ram };

  ptp::Response answer(const ptp::Request& request, Moment now);
  ptp::Response answer_in_session(const ptp::Request& request, Moment now);
  ptp::Response answer_about_object(const ptp::Request& request);
  ptp::Response answer_about_property(const ptp::Request& request);
  ptp::Response device_info() const;
  ptp::Response capture(Target target, Moment now);
  ptp::Response live_view_image(Moment now);
  ptp::Response switch_live_view(bool on);
  ptp::Response queued_events();
  void deliver(const Photo& developed);

  CameraSettings settings_;
  Faults faults_;
  Darkroom* darkroom_;
  ObjectStore objects_;
  std::uint32_t session_ = 0;  // 0: none
  bool frozen_ = false;
  bool live_view_ = false;
  bool preview_asked_ = false;
  bool disconnects_ = false;

  Shutter shutter_ = Shutter::idle;
  int shots_ = 0;
  Target target_ = Target::ram;
  Exposure exposure_;
  std::optional<Photo> developed_;
  std::optional<Photo> before_;  // the last shot's own photo
  std::vector<ptp::Event> queued_events_;
  std::vector<ptp::Event> events_;
};

}  // namespace bodyscan::simulator
