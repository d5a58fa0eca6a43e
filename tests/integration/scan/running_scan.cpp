#include "running_scan.hpp"

#include "tests/support/test_files.hpp"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <csignal>
#include <system_error>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace bodyscan {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr const char* mark_name = "BODYSCAN_TEST_SCAN=";

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> result;
  for (std::string& word : words) result.push_back(word.data());
  result.push_back(nullptr);
  return result;
}

// Its standard error goes to the file `error`, where there is one.
pid_t spawn(std::vector<std::string> words, const std::string& error, const std::string& mark) {
  std::vector<std::string> variables{mark};
  for (char* const* entry = environ; *entry != nullptr; ++entry) variables.emplace_back(*entry);
  posix_spawn_file_actions_t files{};
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  if (!error.empty())
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, error.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                     0644);
  pid_t pid = -1;
  const int code = posix_spawn(&pid, words[0].c_str(), &files, nullptr, pointers(words).data(),
                               pointers(variables).data());
  posix_spawn_file_actions_destroy(&files);
  // No process has the number that is left then: signals sent to it would go to all.
  if (code != 0) throw std::system_error(code, std::generic_category(), words[0]);
  return pid;
}

// Every process there is; what ends meanwhile may or may not be among them.
std::vector<pid_t> all_processes() {
  std::vector<pid_t> pids;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    pid_t pid = 0;
    if (std::from_chars(name.data(), name.data() + name.size(), pid).ptr == name.data() + name.size())
      pids.push_back(pid);
  }
  return pids;
}

std::string about(pid_t pid, const char* file) {
  return read_text("/proc/" + std::to_string(pid) + "/" + file);
}

int status_of(int waited) {
  return WIFEXITED(waited) ? WEXITSTATUS(waited) : -WTERMSIG(waited);
}

}  // namespace

RunningScan::RunningScan(std::vector<std::string> words, std::filesystem::path error)
    : error_(std::move(error)), start_(steady_clock::now()) {
  static std::atomic<int> count{0};
  mark_ = mark_name + std::to_string(getpid()) + "-" + std::to_string(++count);
  pid_ = spawn(std::move(words), error_, mark_);
}

RunningScan::~RunningScan() {
  if (!running()) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

bool RunningScan::running() {
  int waited = 0;
  if (!status_ && waitpid(pid_, &waited, WNOHANG) == pid_) status_ = status_of(waited);
  return !status_;
}

std::optional<pid_t> RunningScan::worker() const {
  for (const pid_t pid : all_processes()) {
    // "PID (NAME) STATE PPID ..."
    const std::string stat = about(pid, "stat");
    const std::size_t name_end = stat.rfind(')');
    if (name_end != std::string::npos &&
        std::atoi(stat.c_str() + std::min(name_end + 4, stat.size())) == pid_)
      return pid;
  }
  return std::nullopt;
}

bool RunningScan::left_behind() const {
  const std::vector<pid_t> pids = all_processes();
  return std::ranges::any_of(
      pids, [&](pid_t pid) { return about(pid, "environ").find(mark_ + '\0') != std::string::npos; });
}

ScanEnd RunningScan::end(milliseconds limit) {
  const auto until = start_ + limit;
  while (running() && steady_clock::now() < until) std::this_thread::sleep_for(milliseconds(2));
  const double seconds = std::chrono::duration<double>(steady_clock::now() - start_).count();
  EXPECT_FALSE(running()) << "still running after " << seconds << " s: " << read_text(error_);
  // Killed processes go in their own time.
  for (int i = 0; i < 100 && left_behind(); ++i) std::this_thread::sleep_for(milliseconds(10));
  EXPECT_FALSE(left_behind());
  return {status_.value_or(-1), read_text(error_), seconds};
}

void run_program(std::vector<std::string> words) {
  const pid_t pid = spawn(std::move(words), {}, std::string(mark_name) + "none");
  int waited = 0;
  EXPECT_EQ(waitpid(pid, &waited, 0), pid);
  EXPECT_EQ(status_of(waited), 0);
}

}  // namespace bodyscan
