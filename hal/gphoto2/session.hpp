#pragma once

#include "hal/gphoto2/handles.hpp"
#include "hal/gphoto2/worker_message.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tl/expected.hpp>

namespace bodyscan::gphoto2 {

template <class Value>
using Outcome = tl::expected<Value, Failure>;

inline tl::unexpected<Failure> refused(std::string message) {
  return tl::unexpected(Failure{false, std::move(message)});
}

// A setting as the camera shows it. Numbers and switches have no choices.
struct Setting {
  std::string name;
  std::string value;
  std::vector<std::string> choices;
  bool read_only = false;

  [[nodiscard]] bool offers(const std::string& choice) const;
};

// A camera that libgphoto2 has initialised. Where the device itself is gone, failures say `lost`.
class Session {
 public:
  static Outcome<std::vector<FoundCamera>> find_cameras();
  // `on_progress` is called while bytes of a picture come in.
  static Outcome<Session> open(const std::string& port, std::function<void()> on_progress);
  Session(Session&&) = default;
  Session& operator=(Session&&) = delete;
  ~Session();

  [[nodiscard]] const FoundCamera& found() const { return found_; }
  [[nodiscard]] ::Camera* camera() const { return camera_.get(); }
  [[nodiscard]] GPContext* context() const { return context_.get(); }

  // Nothing where this camera has no such setting.
  Outcome<std::optional<Setting>> setting(const char* name);
  // The first of the names that the camera has.
  Outcome<std::optional<Setting>> first_setting(const std::vector<const char*>& names);
  Outcome<void> set(const std::string& name, const std::string& value);
  Outcome<void> set_switch(const std::string& name, bool on);

  // What went wrong with the last call that returned `result`: "focusing: I/O problem (PTP Timeout)".
  tl::unexpected<Failure> failure(int result, const std::string& doing);

 private:
  struct Listener {
    std::string last_error;
    std::function<void()> on_progress;
  };
  Session() = default;
  bool still_answers();

  std::unique_ptr<Listener> listener_;
  ContextHandle context_;
  CameraHandle camera_;
  FoundCamera found_;
  bool answering_ = false;
};

}  // namespace bodyscan::gphoto2
