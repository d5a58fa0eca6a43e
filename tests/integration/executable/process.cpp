#include "process.hpp"

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace bodyscan {
namespace {

// Both ends of a pipe; pipes, not files, so that a limit on files does not silence the messages.
std::array<int, 2> make_pipe() {
  std::array<int, 2> ends{};
  EXPECT_EQ(pipe(ends.data()), 0);
  return ends;
}

std::string read_all(int descriptor) {
  std::string text;
  std::array<char, 4096> piece{};
  for (ssize_t count = 0; (count = read(descriptor, piece.data(), piece.size())) > 0;)
    text.append(piece.data(), static_cast<std::size_t>(count));
  close(descriptor);
  return text;
}

[[noreturn]] void become_bodyscan(std::vector<char*> argv, int output, int error,
                                  std::optional<rlim_t> file_bytes) {
  dup2(output, STDOUT_FILENO);
  dup2(error, STDERR_FILENO);
  if (file_bytes) {
    const rlimit limit{*file_bytes, *file_bytes};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  execv(argv[0], argv.data());
  _exit(127);
}

}  // namespace

ProcessResult run_bodyscan(const std::vector<std::string>& arguments, std::optional<rlim_t> file_bytes) {
  std::vector<std::string> words{BODYSCAN_EXECUTABLE};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  const auto [output, output_end] = make_pipe();
  const auto [error, error_end] = make_pipe();
  const pid_t child = fork();
  if (child == 0) become_bodyscan(argv, output_end, error_end, file_bytes);
  close(output_end);
  close(error_end);
  ProcessResult result;
  result.output = read_all(output);
  result.error = read_all(error);
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  return result;
}

}  // namespace bodyscan
