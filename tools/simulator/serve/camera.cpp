#include "tools/simulator/serve/camera.hpp"

#include <utility>

namespace bodyscan::simulator {
namespace {

using ptp::EventCode;
using ptp::Operation;
using ptp::Request;
using ptp::Response;
using ptp::ResponseCode;

constexpr Clock::duration slowness = std::chrono::seconds(1);
constexpr double overexposure = 4;

}  // namespace

Camera::Camera(Size picture, Faults faults, Darkroom& darkroom)
    : settings_(picture, !faults.has(FaultKind::dial)), faults_(std::move(faults)), darkroom_(&darkroom) {}

bool Camera::connect() {
  if (frozen_ && faults_.since(FaultKind::frozen_for_good, shots_)) return false;
  frozen_ = false;
  session_ = 0;
  shutter_ = Shutter::idle;
  developed_.reset();
  preview_asked_ = false;
  switch_live_view(false);
  queued_events_.clear();
  events_.clear();
  return true;
}

std::optional<Response> Camera::execute(const Request& request, Moment now) {
  advance(now);
  if (frozen_) return std::nullopt;
  Response response = answer(request, now);
  if (frozen_) return std::nullopt;
  return response;
}

Response Camera::answer(const Request& request, Moment now) {
  if (request.operation == Operation::get_device_info) return device_info();
  if (request.operation == Operation::open_session) {
    if (session_ != 0) return {ResponseCode::session_already_open, {session_}};
    if (request.parameters[0] == 0) return {ResponseCode::invalid_parameter};
    session_ = request.parameters[0];
    return {};
  }
  if (session_ == 0) return {ResponseCode::session_not_open};
  return answer_in_session(request, now);
}

Response Camera::capture(Target target, Moment now) {
  if (shutter_ != Shutter::idle) return {ResponseCode::device_busy};
  if (target == Target::card && objects_.full()) return {ResponseCode::store_full};
  ++shots_;
  darkroom_->shutter_opened(shots_, now);
  if (faults_.at(FaultKind::frozen, shots_) || faults_.at(FaultKind::frozen_for_good, shots_)) {
    frozen_ = true;
    return {};
  }
  target_ = target;
  exposure_ = {shots_, now, now + settings_.exposure_time(), settings_.exposure_gain(),
               faults_.displacement(shots_)};
  if (faults_.at(FaultKind::exposure, shots_)) exposure_.gain *= overexposure;
  shutter_ = Shutter::exposing;
  return {};
}

std::optional<Moment> Camera::next_due() const {
  if (shutter_ == Shutter::exposing) {
    const bool drops = faults_.at(FaultKind::disconnect, exposure_.shot);
    return drops ? exposure_.begin + (exposure_.end - exposure_.begin) / 2 : exposure_.end;
  }
  if (shutter_ == Shutter::developing && developed_ && faults_.has(FaultKind::slow))
    return exposure_.end + slowness;
  return std::nullopt;
}

void Camera::advance(Moment now) {
  if (shutter_ == Shutter::exposing && now >= *next_due()) {
    if (faults_.at(FaultKind::disconnect, exposure_.shot)) {
      shutter_ = Shutter::idle;
      disconnects_ = true;
      return;
    }
    shutter_ = Shutter::developing;
    darkroom_->develop(exposure_);
  }
  if (shutter_ != Shutter::developing) return;
  if (!developed_) developed_ = darkroom_->take_photo();
  if (!developed_ || (faults_.has(FaultKind::slow) && now < exposure_.end + slowness)) return;
  deliver(*std::exchange(developed_, std::nullopt));
}

void Camera::deliver(const Photo& developed) {
  const bool is_the_one_before =
      faults_.at(FaultKind::stale, exposure_.shot) || faults_.since(FaultKind::late, exposure_.shot);
  const Photo photo = is_the_one_before && before_ ? *before_ : developed;
  before_ = developed;
  shutter_ = Shutter::idle;
  if (target_ == Target::ram) {
    const std::uint32_t handle = objects_.put_in_ram(photo, exposure_.shot);
    queued_events_.push_back({EventCode::nikon_object_added_in_sdram, handle});
    queued_events_.push_back({EventCode::nikon_capture_complete_rec_in_sdram, 0});
  } else {
    events_.push_back({EventCode::object_added, objects_.put_on_card(photo, exposure_.shot)});
    events_.push_back({EventCode::capture_complete, 0});
  }
}

std::vector<ptp::Event> Camera::take_events() {
  return std::exchange(events_, {});
}

bool Camera::take_disconnection() {
  return std::exchange(disconnects_, false);
}

Response Camera::live_view_image(Moment now) {
  constexpr std::size_t header_bytes = 64;  // the D5000's; its content is not needed to find the JPEG
  constexpr Clock::duration exposure_time = std::chrono::milliseconds(33);
  if (!live_view_) return {ResponseCode::nikon_not_live_view};
  if (!preview_asked_) {
    darkroom_->develop_preview({shots_, now - exposure_time, now, 1, faults_.displacement(shots_)});
    preview_asked_ = true;
  }
  const SharedBytes jpeg = darkroom_->take_preview();
  if (!jpeg) return {ResponseCode::device_busy};
  preview_asked_ = false;
  ptp::DatasetWriter writer;
  writer.raw(ptp::Bytes(header_bytes)).raw(*jpeg);
  return ptp::with_data(writer.take());
}

Response Camera::switch_live_view(bool on) {
  live_view_ = on;
  settings_.show(ptp::PropertyCode::nikon_live_view_status, on ? 1 : 0);
  return {};
}

Response Camera::queued_events() {
  ptp::DatasetWriter writer;
  writer.put(static_cast<std::uint16_t>(queued_events_.size()));
  for (const ptp::Event& event : queued_events_) writer.put(event.code).put(event.parameter);
  queued_events_.clear();
  return ptp::with_data(writer.take());
}

}  // namespace bodyscan::simulator
