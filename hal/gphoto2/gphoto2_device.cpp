#include "hal/gphoto2/gphoto2_device.hpp"

#include "hal/gphoto2/scan_settings.hpp"
#include "hal/gphoto2/setting_text.hpp"

#include <chrono>
#include <cstdlib>
#include <memory>
#include <utility>

namespace bodyscan::gphoto2 {
namespace {

constexpr int picture_patience_ms = 1'800;  // less than what the parent gives us
constexpr double low_battery_percent = 20;

std::int64_t now_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

Outcome<std::string> value_of(Session& session, const char* name) {
  auto setting = session.setting(name);
  if (!setting) return tl::unexpected(setting.error());
  return *setting ? (*setting)->value : std::string();
}

Outcome<void> find_problems(Session& session, std::vector<std::string>& problems) {
  const auto manual = dial_is_manual(session);
  if (!manual) return tl::unexpected(manual.error());
  if (!*manual) problems.emplace_back(dial_problem);
  const auto aperture = aperture_setting(session);
  if (!aperture) return tl::unexpected(aperture.error());
  if (*aperture && !f_number((*aperture)->value))
    problems.emplace_back("the lens does not answer: put it on until it clicks");
  const auto battery = value_of(session, "batterylevel");
  const auto mains = value_of(session, "acpower");
  if (!battery || !mains) return tl::unexpected((battery ? mains : battery).error());
  const auto charge = percent(*battery);
  if (charge && *charge < low_battery_percent && *mains != "On")
    problems.push_back("the battery is at " + *battery + ": charge it or use the mains adapter");
  return {};
}

}  // namespace

Outcome<Gphoto2Device> Gphoto2Device::open(const std::string& port, std::function<void()> on_progress) {
  auto session = Session::open(port, std::move(on_progress));
  if (!session) return tl::unexpected(session.error());
  return Gphoto2Device(std::move(*session));
}

Outcome<Opened> Gphoto2Device::identify() {
  const auto model = value_of(session_, "cameramodel");
  if (!model) return tl::unexpected(model.error());
  const auto serial = value_of(session_, "serialnumber");
  if (!serial) return tl::unexpected(serial.error());
  Opened opened;
  opened.identity.model = model->empty() ? session_.found().model : *model;
  opened.identity.serial = *serial;
  opened.port = session_.found().port;
  if (const auto found = find_problems(session_, opened.identity.problems); !found)
    return tl::unexpected(found.error());
  return opened;
}

Outcome<CameraSettings> Gphoto2Device::configure(const CameraSettings& wanted) {
  if (const auto ended = end_live_view(); !ended) return tl::unexpected(ended.error());
  return apply_scan_settings(session_, wanted);
}

// gp_camera_capture would return with the picture already transferred; triggering and waiting are what lets
// the next pattern be shown meanwhile.
Outcome<void> Gphoto2Device::expose() {
  if (auto ended = end_live_view(); !ended) return ended;
  if (auto forgotten = forget_earlier_pictures(); !forgotten) return forgotten;
  int result = gp_camera_trigger_capture(session_.camera(), session_.context());
  if (result == GP_ERROR_NOT_SUPPORTED) {
    CameraFilePath path{};
    result = gp_camera_capture(session_.camera(), GP_CAPTURE_IMAGE, &path, session_.context());
    if (result >= GP_OK) captured_ = path;
  }
  exposure_end_us_ = now_us();
  if (result < GP_OK) return session_.failure(result, "the shot failed");
  return {};
}

Outcome<DevicePicture> Gphoto2Device::fetch() {
  if (!captured_) {
    auto announced = announced_picture(picture_patience_ms);
    if (!announced) return tl::unexpected(announced.error());
    if (!*announced) return tl::unexpected(Failure{true, "the shot's picture does not come"});
    captured_ = *announced;
  }
  const CameraFilePath path = *std::exchange(captured_, std::nullopt);
  DevicePicture picture{make_handle<FileHandle>(gp_file_new), exposure_end_us_};
  const int result = gp_camera_file_get(session_.camera(), path.folder, path.name, GP_FILE_TYPE_NORMAL,
                                        picture.file.get(), session_.context());
  if (result < GP_OK) return session_.failure(result, "the picture cannot be read");
  // Off the card, or out of libgphoto2's memory; a camera that keeps it does no harm.
  gp_camera_file_delete(session_.camera(), path.folder, path.name, session_.context());
  return picture;
}

Outcome<DevicePicture> Gphoto2Device::preview() {
  DevicePicture picture{make_handle<FileHandle>(gp_file_new), 0};
  live_view_ = true;
  const int result = gp_camera_capture_preview(session_.camera(), picture.file.get(), session_.context());
  if (result < GP_OK) return session_.failure(result, "it shows no preview");
  picture.exposure_end_us = now_us();
  return picture;
}

Outcome<void> Gphoto2Device::end_live_view() {
  if (!std::exchange(live_view_, false)) return {};
  const auto viewfinder = session_.setting("viewfinder");
  if (!viewfinder) return tl::unexpected(viewfinder.error());
  if (!*viewfinder) return {};
  return session_.set_switch("viewfinder", false);
}

// A picture that an aborted shot left behind would be taken for the next shot's (libgphoto2 issue 1124).
Outcome<void> Gphoto2Device::forget_earlier_pictures() {
  captured_.reset();
  for (;;) {
    const auto stale = announced_picture(0);
    if (!stale) return tl::unexpected(stale.error());
    if (!*stale) return {};
    gp_camera_file_delete(session_.camera(), (*stale)->folder, (*stale)->name, session_.context());
  }
}

Outcome<std::optional<CameraFilePath>> Gphoto2Device::announced_picture(int patience_ms) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::milliseconds(patience_ms);
  for (;;) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    CameraEventType type = GP_EVENT_UNKNOWN;
    void* raw = nullptr;
    const int result =
        gp_camera_wait_for_event(session_.camera(), static_cast<int>(std::max<std::int64_t>(left.count(), 0)),
                                 &type, &raw, session_.context());
    const std::unique_ptr<void, decltype(&std::free)> data(raw, &std::free);
    if (result < GP_OK) return session_.failure(result, "waiting for the picture");
    if (type == GP_EVENT_FILE_ADDED && raw != nullptr) return *static_cast<const CameraFilePath*>(raw);
    if (type == GP_EVENT_TIMEOUT) return std::nullopt;
    // Other events while nothing is waited for: look until there are no more, but not for ever.
    if (left.count() <= -200) return std::nullopt;
  }
}

}  // namespace bodyscan::gphoto2
