#include "hal/gphoto2/gphoto2_camera.hpp"

#include "hal/gphoto2/picture_memory.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <variant>

namespace bodyscan::gphoto2 {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr int longest_exposure_us = 30'000'000;  // of the shutter's own times, where none was configured
constexpr milliseconds patience_with_the_dying{100};

std::string name_at(const std::string& model, const std::string& port) {
  std::string name = "camera";
  if (!model.empty()) name += " " + model;
  if (!port.empty()) name += " at " + port;
  return name;
}

}  // namespace

struct Gphoto2Camera::Answer {
  Reply reply;
  UniqueFd attachment;
};

Gphoto2Camera::Gphoto2Camera(Gphoto2Options options)
    : options_(std::move(options)), name_(name_at("", options_.port)) {}

Gphoto2Camera::~Gphoto2Camera() {
  Gphoto2Camera::close();
}

Expected<CameraIdentity> Gphoto2Camera::open() {
  if (state_ != State::lost)
    if (const Expected<void> fits = require(State::closed, "open"); !fits)
      return tl::unexpected(fits.error());
  Expected<WorkerProcess> worker = WorkerProcess::start(options_.worker);
  if (!worker) return failure(worker.error().message);
  worker_ = std::move(*worker);
  exposure_us_ = longest_exposure_us;
  Expected<Opened> opened = ask<Opened>(OpenCamera{options_.port}, options_.deadlines.open);
  if (!opened) {
    worker_.dismiss(options_.deadlines.close);
    return tl::unexpected(opened.error());
  }
  name_ = name_at(opened->identity.model, opened->port);
  state_ = State::ready;
  return std::move(opened->identity);
}

Expected<CameraSettings> Gphoto2Camera::configure(const CameraSettings& wanted) {
  if (const Expected<void> fits = require(State::ready, "configure"); !fits)
    return tl::unexpected(fits.error());
  const Expected<Configured> configured = ask<Configured>(Configure{wanted}, options_.deadlines.configure);
  if (!configured) return tl::unexpected(configured.error());
  exposure_us_ = configured->settings.exposure_us;
  return configured->settings;
}

Expected<void> Gphoto2Camera::expose() {
  if (Expected<void> fits = require(State::ready, "expose"); !fits) return fits;
  const auto exposure = std::chrono::ceil<milliseconds>(microseconds(exposure_us_));
  const Expected<Exposed> exposed = ask<Exposed>(Expose{}, exposure + options_.deadlines.expose);
  if (!exposed) return tl::unexpected(exposed.error());
  state_ = State::exposed;
  return {};
}

Expected<Photograph> Gphoto2Camera::fetch() {
  if (const Expected<void> fits = require(State::exposed, "fetch"); !fits)
    return tl::unexpected(fits.error());
  state_ = State::ready;
  return ask_for_picture(Fetch{}, options_.deadlines.fetch);
}

Expected<Photograph> Gphoto2Camera::preview() {
  if (const Expected<void> fits = require(State::ready, "preview"); !fits)
    return tl::unexpected(fits.error());
  return ask_for_picture(Preview{}, options_.deadlines.preview);
}

void Gphoto2Camera::close() {
  worker_.dismiss(options_.deadlines.close);
  state_ = State::closed;
}

const char* Gphoto2Camera::name_of(State state) {
  switch (state) {
    case State::closed:
      return "closed";
    case State::ready:
      return "ready";
    case State::exposed:
      return "exposed";
    case State::lost:
      break;
  }
  return "lost";
}

Expected<void> Gphoto2Camera::require(State needed, const char* call) const {
  if (state_ == needed) return {};
  const std::string remedy = state_ == State::lost ? ": open it again" : "";
  return failure(std::string(call) + " needs it " + name_of(needed) + ", it is " + name_of(state_) + remedy);
}

template <class Wanted>
Expected<Wanted> Gphoto2Camera::ask(const Request& request, milliseconds patience) {
  Expected<Answer> answer = answer_to(request, patience);
  if (!answer) return tl::unexpected(answer.error());
  auto* wanted = std::get_if<Wanted>(&answer->reply);
  if (wanted == nullptr || answer->attachment) return lose(ChannelTrouble::malformed);
  return std::move(*wanted);
}

Expected<Photograph> Gphoto2Camera::ask_for_picture(const Request& request, milliseconds patience) {
  const Expected<Answer> answer = answer_to(request, patience);
  if (!answer) return tl::unexpected(answer.error());
  const auto* ready = std::get_if<PictureReady>(&answer->reply);
  if (ready == nullptr || !answer->attachment) return lose(ChannelTrouble::malformed);
  auto file = read_sealed_picture(answer->attachment.get(), ready->bytes);
  if (!file) return lose(ChannelTrouble::malformed);
  return Photograph{std::move(*file), ready->exposure_end_us};
}

// The reply that ends the request; a Failure becomes an error.
Expected<Gphoto2Camera::Answer> Gphoto2Camera::answer_to(const Request& request, milliseconds patience) {
  const auto start = std::chrono::steady_clock::now();
  const Deadline last = start + std::max(patience, options_.deadlines.transfer);
  Deadline deadline = start + patience;
  const std::uint32_t number = ++requests_;
  if (const auto sent = send(worker_.socket(), encode(number, request), -1, deadline); !sent)
    return lose(sent.error());
  const bool may_progress =
      std::holds_alternative<Fetch>(request) || std::holds_alternative<Preview>(request);
  for (;;) {
    auto datagram = receive(worker_.socket(), deadline);
    if (!datagram) return lose(datagram.error());
    auto reply = decode_reply(datagram->bytes);
    if (!reply || reply->number != number) return lose(ChannelTrouble::malformed);
    if (std::holds_alternative<Progress>(reply->message)) {
      if (!may_progress || datagram->attachment) return lose(ChannelTrouble::malformed);
      const auto now = std::chrono::steady_clock::now();
      if (now >= last) return lose(ChannelTrouble::late);
      deadline = std::min(last, now + patience);
      continue;
    }
    if (const auto* failed = std::get_if<Failure>(&reply->message))
      return failed->lost ? lose(failed->message) : failure(failed->message);
    return Answer{std::move(reply->message), std::move(datagram->attachment)};
  }
}

tl::unexpected<Error> Gphoto2Camera::lose(ChannelTrouble trouble) {
  switch (trouble) {
    case ChannelTrouble::late:
      return lose("does not answer");
    case ChannelTrouble::malformed:
      return lose("its driver answered nonsense");
    case ChannelTrouble::closed:
      break;
  }
  const std::string end = worker_.kill(patience_with_the_dying);
  return lose("its driver stopped" + (end.empty() ? end : " (" + end + ")"));
}

tl::unexpected<Error> Gphoto2Camera::lose(const std::string& reason) {
  worker_.kill();
  state_ = State::lost;
  return failure(reason + ": switch it off and on, check the cable");
}

tl::unexpected<Error> Gphoto2Camera::failure(const std::string& reason) const {
  return device_error(name_ + ": " + reason);
}

Expected<std::vector<FoundCamera>> list_cameras(const WorkerProgram& worker, milliseconds patience) {
  Expected<WorkerProcess> process = WorkerProcess::start(worker);
  if (!process) return tl::unexpected(process.error());
  const Deadline deadline = std::chrono::steady_clock::now() + patience;
  const auto no_answer = [] {
    return device_error("cameras cannot be listed: their driver does not answer");
  };
  if (!send(process->socket(), encode(1, Request(ListCameras{})), -1, deadline)) return no_answer();
  const auto datagram = receive(process->socket(), deadline);
  if (!datagram) return no_answer();
  auto reply = decode_reply(datagram->bytes);
  if (!reply || reply->number != 1) return no_answer();
  process->dismiss(Deadlines{}.close);
  if (const auto* failed = std::get_if<Failure>(&reply->message))
    return device_error("cameras cannot be listed: " + failed->message);
  auto* list = std::get_if<CamerasFound>(&reply->message);
  if (list == nullptr) return no_answer();
  return std::move(list->cameras);
}

}  // namespace bodyscan::gphoto2
