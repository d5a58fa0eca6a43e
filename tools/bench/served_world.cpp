#include "tools/bench/served_world.hpp"

#include <csignal>
#include <cstdio>
#include <sstream>
#include <utility>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace bodyscan {
namespace {

// The first line that comes out of a pipe; empty at its end.
std::string first_line(int pipe) {
  std::string line;
  char next = 0;
  while (read(pipe, &next, 1) == 1 && next != '\n') line += next;
  return line;
}

}  // namespace

Expected<ServedWorld> ServedWorld::start(std::vector<std::string> arguments,
                                         const std::filesystem::path& folder) {
  ServedWorld world;
  const std::string socket = folder / "projector";
  arguments.insert(arguments.begin(), {BODYSCAN_SIMULATOR, "serve", "--projector", socket});
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return output_error("no pipe");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  const int failed = posix_spawn(&world.pid_, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  std::istringstream line(failed == 0 ? first_line(ends[0]) : "");
  close(ends[0]);
  if (failed != 0) world.pid_ = -1;
  std::string ready;
  if (!(line >> ready >> world.camera_port_ >> world.projector_socket_) || ready != "ready")
    return output_error(std::string(BODYSCAN_SIMULATOR) + " serve: does not start");
  return world;
}

ServedWorld::ServedWorld(ServedWorld&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)),
      camera_port_(std::move(other.camera_port_)),
      projector_socket_(std::move(other.projector_socket_)) {}

ServedWorld::~ServedWorld() {
  if (pid_ < 0) return;
  kill(pid_, SIGTERM);
  waitpid(pid_, nullptr, 0);
}

}  // namespace bodyscan
