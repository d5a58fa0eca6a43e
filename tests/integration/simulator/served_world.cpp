#include "served_world.hpp"

#include <array>
#include <csignal>
#include <cstdlib>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace bodyscan {
namespace {

struct Child {
  pid_t pid = -1;
  int output = -1;
};

// Starts a program whose standard output and error go into one pipe.
Child start(std::vector<std::string> words, const std::filesystem::path& folder) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  std::array<int, 2> ends{};
  EXPECT_EQ(pipe2(ends.data(), O_CLOEXEC), 0);
  const pid_t pid = fork();
  if (pid == 0) {
    dup2(ends[1], STDOUT_FILENO);
    dup2(ends[1], STDERR_FILENO);
    close(ends[0]);
    close(ends[1]);
    if (chdir(folder.c_str()) != 0 || setenv("HOME", folder.c_str(), 1) != 0) _exit(126);
    execv(argv[0], argv.data());
    _exit(127);
  }
  close(ends[1]);
  return {pid, ends[0]};
}

std::string read_rest(int descriptor) {
  std::string text;
  std::array<char, 4096> piece{};
  for (ssize_t count = 0; (count = read(descriptor, piece.data(), piece.size())) > 0;)
    text.append(piece.data(), static_cast<std::size_t>(count));
  return text;
}

Finished finish(const Child& child) {
  Finished finished;
  finished.output = read_rest(child.output);
  close(child.output);
  int status = 0;
  EXPECT_EQ(waitpid(child.pid, &status, 0), child.pid);
  finished.status = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  return finished;
}

}  // namespace

ServedWorld::ServedWorld(const std::vector<std::string>& options) {
  std::vector<std::string> words{BODYSCAN_SIMULATOR, "serve", "--projector", projector()};
  words.insert(words.end(), options.begin(), options.end());
  const Child child = start(words, folder_.path());
  pid_ = child.pid;
  output_ = child.output;
  for (char character = 0; read(output_, &character, 1) == 1 && character != '\n';) ready_line_ += character;
}

std::string ServedWorld::camera() const {
  const std::size_t begin = ready_line_.find(' ') + 1;
  return ready_line_.substr(begin, ready_line_.find(' ', begin) - begin);
}

Finished ServedWorld::gphoto2(const std::vector<std::string>& arguments) {
  std::vector<std::string> words{GPHOTO2, "--port", camera()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return finish(start(words, folder_.path()));
}

Finished ServedWorld::end(int signal) {
  if (pid_ < 0) return {};
  kill(pid_, signal);
  const Child child{pid_, output_};
  pid_ = -1;
  return finish(child);
}

}  // namespace bodyscan
