#pragma once

#include "hal/camera.hpp"
#include "hal/gphoto2/worker_channel.hpp"
#include "hal/gphoto2/worker_message.hpp"
#include "hal/gphoto2/worker_process.hpp"

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace bodyscan::gphoto2 {

// After which a camera that has not answered is lost.
struct Deadlines {
  std::chrono::milliseconds open{10'000};
  std::chrono::milliseconds configure{10'000};
  std::chrono::milliseconds expose{2'000};  // on top of the exposure
  // Since the last bytes came in, where libgphoto2 tells (USB); over a network for the whole picture.
  std::chrono::milliseconds fetch{2'000};
  std::chrono::milliseconds preview{2'000};
  std::chrono::milliseconds close{1'000};
  std::chrono::milliseconds transfer{30'000};  // a picture or a preview, however steadily it comes
};

struct Gphoto2Options {
  std::string port;  // "usb:001,004", "ptpip:HOST:PORT:PORT"; empty: the first camera found on USB
  WorkerProgram worker;
  Deadlines deadlines;
};

// A camera behind libgphoto2, which hangs and crashes on a bad link and so runs in a worker process. A worker
// that dies, breaks the protocol or is late is killed and the camera is lost; `open` starts a fresh one.
class Gphoto2Camera final : public Camera {
 public:
  explicit Gphoto2Camera(Gphoto2Options options);
  ~Gphoto2Camera() override;

  Expected<CameraIdentity> open() override;
  Expected<CameraSettings> configure(const CameraSettings& wanted) override;
  Expected<void> expose() override;
  Expected<Photograph> fetch() override;
  Expected<Photograph> preview() override;
  void close() override;

  // The worker's process; -1 while there is none.
  [[nodiscard]] pid_t worker_pid() const { return worker_.pid(); }

 private:
  enum class State { closed, ready, exposed, lost };
  struct Answer;

  static const char* name_of(State state);
  Expected<void> require(State needed, const char* call) const;
  template <class Wanted>
  Expected<Wanted> ask(const Request& request, std::chrono::milliseconds patience);
  Expected<Answer> answer_to(const Request& request, std::chrono::milliseconds patience);
  Expected<Photograph> ask_for_picture(const Request& request, std::chrono::milliseconds patience);
  tl::unexpected<Error> lose(ChannelTrouble trouble);
  tl::unexpected<Error> lose(const std::string& reason);
  [[nodiscard]] tl::unexpected<Error> failure(const std::string& reason) const;

  Gphoto2Options options_;
  State state_ = State::closed;
  WorkerProcess worker_;
  std::uint32_t requests_ = 0;
  std::string name_;  // "camera D5000 at usb:001,004"
  int exposure_us_ = 0;
};

// What is plugged in, found by a worker of its own.
Expected<std::vector<FoundCamera>> list_cameras(const WorkerProgram& worker = {},
                                                std::chrono::milliseconds patience = Deadlines{}.open);

}  // namespace bodyscan::gphoto2
