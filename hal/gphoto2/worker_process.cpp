#include "hal/gphoto2/worker_process.hpp"

#include "hal/gphoto2/worker_channel.hpp"

#include <array>
#include <csignal>
#include <cstdint>
#include <string_view>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

extern "C" {  // glibc 2.36 leaves that out
#include <sys/pidfd.h>
}

namespace bodyscan::gphoto2 {
namespace {

using std::chrono::milliseconds;

// A killed process is gone in microseconds, but one stuck in a USB driver's call cannot be waited for.
constexpr milliseconds patience_with_the_kernel{500};

tl::unexpected<Error> start_error(int code) {
  return device_error("the camera worker cannot be started: " + std::generic_category().message(code));
}

class SpawnPlan {
 public:
  SpawnPlan() {
    ::posix_spawn_file_actions_init(&files_);
    ::posix_spawnattr_init(&attributes_);
  }
  SpawnPlan(const SpawnPlan&) = delete;
  SpawnPlan& operator=(const SpawnPlan&) = delete;
  ~SpawnPlan() {
    ::posix_spawn_file_actions_destroy(&files_);
    ::posix_spawnattr_destroy(&attributes_);
  }

  // 0 or errno's value.
  int prepare(int socket) {
    sigset_t all;
    sigset_t none;
    sigfillset(&all);
    sigemptyset(&none);
    int code = ::posix_spawn_file_actions_adddup2(&files_, socket, worker_socket);
    const auto then = [&](int next) { code = code != 0 ? code : next; };
    then(::posix_spawn_file_actions_addopen(&files_, STDIN_FILENO, "/dev/null", O_RDONLY, 0));
    then(::posix_spawn_file_actions_addopen(&files_, STDOUT_FILENO, "/dev/null", O_WRONLY, 0));
    then(::posix_spawn_file_actions_addclosefrom_np(&files_, worker_socket + 1));
    then(::posix_spawnattr_setsigdefault(&attributes_, &all));
    then(::posix_spawnattr_setsigmask(&attributes_, &none));
    then(::posix_spawnattr_setpgroup(&attributes_, 0));
    then(::posix_spawnattr_setflags(&attributes_,
                                    POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP));
    return code;
  }

  int spawn(pid_t& pid, const char* executable, char* const* argv, char* const* environment) {
    return ::posix_spawn(&pid, executable, &files_, &attributes_, argv, environment);
  }

 private:
  posix_spawn_file_actions_t files_{};
  posix_spawnattr_t attributes_{};
};

// Ours, with HOME pinned, and no language: the camera's choices are compared by their English names.
std::vector<std::string> worker_environment(const std::string& home) {
  std::vector<std::string> variables{"HOME=" + (home.empty() ? "/dev/null" : home), "LC_ALL=C"};
  for (char* const* entry = environ; *entry != nullptr; ++entry) {
    const std::string_view variable = *entry;
    const std::string_view name = variable.substr(0, variable.find('='));
    if (name != "HOME" && name != "LC_ALL" && name != "LANGUAGE") variables.emplace_back(variable);
  }
  return variables;
}

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> result;
  for (std::string& word : words) result.push_back(word.data());
  result.push_back(nullptr);
  return result;
}

// How it ended, once it has.
std::string reap(pid_t pid, int process, milliseconds patience) {
  if (!wait_for(process, POLLIN, std::chrono::steady_clock::now() + patience)) return {};
  siginfo_t info{};
  int code = 0;
  do code = ::waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED | WNOHANG);
  while (code != 0 && errno == EINTR);
  if (code != 0 || info.si_pid != pid) return {};
  return (info.si_code == CLD_EXITED ? "exit status " : "signal ") + std::to_string(info.si_status);
}

}  // namespace

WorkerProcess::WorkerProcess(pid_t pid, UniqueFd process, UniqueFd socket)
    : pid_(pid), process_(std::move(process)), socket_(std::move(socket)) {}

WorkerProcess::WorkerProcess(WorkerProcess&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)),
      process_(std::move(other.process_)),
      socket_(std::move(other.socket_)) {}

WorkerProcess& WorkerProcess::operator=(WorkerProcess&& other) noexcept {
  if (this != &other) {
    kill();
    pid_ = std::exchange(other.pid_, -1);
    process_ = std::move(other.process_);
    socket_ = std::move(other.socket_);
  }
  return *this;
}

WorkerProcess::~WorkerProcess() {
  kill();
}

Expected<WorkerProcess> WorkerProcess::start(const WorkerProgram& program) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) return start_error(errno);
  UniqueFd ours(ends[0]);
  const UniqueFd theirs(ends[1]);

  std::vector<std::string> words{"bodyscan"};
  words.insert(words.end(), program.arguments.begin(), program.arguments.end());
  std::vector<std::string> variables = worker_environment(program.home);
  SpawnPlan plan;
  if (const int code = plan.prepare(theirs.get())) return start_error(code);
  pid_t pid = -1;
  if (const int code =
          plan.spawn(pid, program.executable.c_str(), pointers(words).data(), pointers(variables).data()))
    return start_error(code);
  UniqueFd process(::pidfd_open(pid, 0));
  if (!process) {
    const int code = errno;
    ::kill(pid, SIGKILL);
    ::waitpid(pid, nullptr, 0);
    return start_error(code);
  }
  return WorkerProcess(pid, std::move(process), std::move(ours));
}

void WorkerProcess::dismiss(milliseconds patience) {
  if (!running()) return;
  socket_.reset();
  kill(patience);
}

std::string WorkerProcess::kill(milliseconds patience) {
  if (!running()) return {};
  std::string end = reap(pid_, process_.get(), patience);
  if (end.empty()) {
    ::pidfd_send_signal(process_.get(), SIGKILL, nullptr, 0);
    reap(pid_, process_.get(), patience_with_the_kernel);
  }
  pid_ = -1;
  process_.reset();
  socket_.reset();
  return end;
}

}  // namespace bodyscan::gphoto2
