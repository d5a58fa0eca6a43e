#include "tools/bench/child_process.hpp"

#include <chrono>
#include <cstring>

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>

extern char** environ;

namespace bodyscan {
namespace {

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
}

}  // namespace

Expected<ProcessUsage> run_program(const std::vector<std::string>& arguments,
                                   const std::filesystem::path& output) {
  std::vector<char*> words;
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  const std::string sink = output.empty() ? "/dev/null" : output.string();

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, sink.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  const auto start = std::chrono::steady_clock::now();
  pid_t child = 0;
  const int problem = posix_spawnp(&child, words[0], &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (problem != 0) return input_error(arguments[0] + ": " + std::strerror(problem));

  int status = 0;
  rusage usage{};
  while (wait4(child, &status, 0, &usage) < 0) {
    if (errno != EINTR) return input_error(arguments[0] + ": " + std::strerror(errno));
  }
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  return ProcessUsage{.exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
                      .wall_s = wall.count(),
                      .cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime),
                      .peak_memory_mb = static_cast<double>(usage.ru_maxrss) * 1024e-6};
}

}  // namespace bodyscan
