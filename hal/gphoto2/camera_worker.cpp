#include "hal/gphoto2/camera_worker.hpp"

#include "hal/gphoto2/gphoto2_device.hpp"
#include "hal/gphoto2/picture_memory.hpp"
#include "hal/gphoto2/worker_channel.hpp"
#include "hal/gphoto2/worker_process.hpp"

#include <csignal>
#include <cstdio>
#include <exception>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

namespace bodyscan::gphoto2 {
namespace {

pid_t parent = 0;

// The kernel also sends this when only the thread that started us has ended.
void leave_without_parent(int /*signal*/) {
  if (::getppid() != parent) ::_exit(1);
}

void die_with_parent() {
  parent = ::getppid();
  struct sigaction action = {};
  action.sa_handler = leave_without_parent;
  action.sa_flags = SA_RESTART;
  ::sigaction(SIGUSR1, &action, nullptr);
  ::prctl(PR_SET_PDEATHSIG, SIGUSR1);
}

bool is_worker_socket(int descriptor) {
  int type = 0;
  socklen_t size = sizeof type;
  return ::getsockopt(descriptor, SOL_SOCKET, SO_TYPE, &type, &size) == 0 && type == SOCK_SEQPACKET;
}

// libgphoto2 writes there what its caller is told as well.
void silence_standard_error() {
  const UniqueFd nowhere(::open("/dev/null", O_WRONLY | O_CLOEXEC));
  if (nowhere) ::dup2(nowhere.get(), STDERR_FILENO);
}

class Worker {
 public:
  explicit Worker(int socket) : socket_(socket) {}

  int serve() {
    for (;;) {
      const auto datagram = receive(socket_, no_deadline);
      if (!datagram) return datagram.error() == ChannelTrouble::closed ? 0 : 1;
      const auto request = decode_request(datagram->bytes);
      if (!request) return 1;
      number_ = request->number;
      UniqueFd attachment;
      const Reply reply = answer(request->message, attachment);
      if (!send(socket_, encode(number_, reply), attachment.get(), no_deadline)) return 0;
    }
  }

 private:
  Reply answer(const Request& request, UniqueFd& attachment) {
    if (std::holds_alternative<ListCameras>(request)) {
      auto cameras = Session::find_cameras();
      return cameras ? Reply(CamerasFound{std::move(*cameras)}) : Reply(cameras.error());
    }
    if (const auto* open = std::get_if<OpenCamera>(&request)) return this->open(open->port);
    if (!device_) return Failure{false, "is not open"};
    if (const auto* configure = std::get_if<Configure>(&request)) {
      const auto settings = device_->configure(configure->wanted);
      return settings ? Reply(Configured{*settings}) : Reply(settings.error());
    }
    if (std::holds_alternative<Expose>(request)) {
      const auto exposed = device_->expose();
      return exposed ? Reply(Exposed{}) : Reply(exposed.error());
    }
    transferring_ = true;
    const auto picture = std::holds_alternative<Fetch>(request) ? device_->fetch() : device_->preview();
    transferring_ = false;
    return picture ? hand_over(*picture, attachment) : Reply(picture.error());
  }

  Reply open(const std::string& port) {
    device_.reset();
    auto device = Gphoto2Device::open(port, [this] { tell_progress(); });
    if (!device) return device.error();
    device_.emplace(std::move(*device));
    auto opened = device_->identify();
    return opened ? Reply(std::move(*opened)) : Reply(opened.error());
  }

  static Reply hand_over(const DevicePicture& picture, UniqueFd& attachment) {
    const char* data = nullptr;
    unsigned long bytes = 0;
    const char* type = nullptr;
    gp_file_get_data_and_size(picture.file.get(), &data, &bytes);
    gp_file_get_mime_type(picture.file.get(), &type);
    if (data == nullptr || bytes == 0) return Failure{false, "its picture is empty"};
    if (bytes > max_picture_bytes) return Failure{false, "its picture is too large"};
    if (type != nullptr && std::string_view(type) != GP_MIME_JPEG)
      return Failure{false, "its picture is no JPEG, but " + std::string(type)};
    auto memory = seal_picture(std::as_bytes(std::span(data, bytes)));
    if (!memory) return Failure{false, memory.error().message};
    attachment = std::move(*memory);
    return PictureReady{bytes, picture.exposure_end_us};
  }

  // Missed ones do no harm: there are many.
  void tell_progress() {
    if (transferring_) (void)send(socket_, encode(number_, Reply(Progress{})), -1, Deadline{});
  }

  int socket_;
  std::uint32_t number_ = 0;
  bool transferring_ = false;
  std::optional<Gphoto2Device> device_;
};

}  // namespace

bool is_camera_worker(int argc, const char* const* argv) {
  return argc == 2 && std::string_view(argv[1]) == worker_role;
}

int run_camera_worker() {
  if (!is_worker_socket(worker_socket)) {
    std::fprintf(stderr, "bodyscan: %s: is started by bodyscan itself\n", worker_role);
    return 2;
  }
  die_with_parent();
  std::signal(SIGPIPE, SIG_IGN);  // the camera may be at the other end of a network
  ::fcntl(worker_socket, F_SETFD, FD_CLOEXEC);
  silence_standard_error();
  try {
    return Worker(worker_socket).serve();
  } catch (const std::exception&) {
    return 1;
  }
}

}  // namespace bodyscan::gphoto2
