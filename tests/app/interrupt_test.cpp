#include "app/interrupt.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

namespace bodyscan {
namespace {

// Each case runs in a process of its own: signals once handled stay handled.
[[noreturn]] void exit_with(bool success) {
  std::_Exit(success ? 0 : 1);
}

TEST(Interrupt, FirstSignalIsRememberedAndTold) {
  EXPECT_EXIT(
      {
        install_signal_handlers();
        const bool before = check_interrupt().has_value();
        std::raise(SIGTERM);
        const auto after = check_interrupt();
        exit_with(before && !after && after.error().message == "interrupted");
      },
      testing::ExitedWithCode(0), "");
}

TEST(Interrupt, SecondSignalEndsTheProcess) {
  EXPECT_EXIT(
      {
        install_signal_handlers();
        std::raise(SIGINT);
        std::raise(SIGINT);
        exit_with(true);
      },
      testing::KilledBySignal(SIGINT), "");
}

TEST(Interrupt, ProcessEndsByTheRememberedSignal) {
  EXPECT_EXIT(
      {
        install_signal_handlers();
        std::raise(SIGHUP);
        end_by_remembered_signal();
        exit_with(true);
      },
      testing::KilledBySignal(SIGHUP), "");
  EXPECT_EXIT(
      {
        install_signal_handlers();
        end_by_remembered_signal();
        std::_Exit(7);
      },
      testing::ExitedWithCode(7), "");
}

bool write_to_broken_pipe_fails() {
  std::array<int, 2> ends{};
  return pipe(ends.data()) == 0 && close(ends[0]) == 0 && write(ends[1], "x", 1) == -1 && errno == EPIPE;
}

bool write_over_the_limit_fails() {
  std::string name = std::filesystem::temp_directory_path() / "bodyscan-limit-XXXXXX";
  const int file = mkstemp(name.data());
  unlink(name.c_str());
  const rlimit limit{0, 0};
  return setrlimit(RLIMIT_FSIZE, &limit) == 0 && write(file, "x", 1) == -1 && errno == EFBIG;
}

TEST(Interrupt, BrokenPipeAndFileSizeLimitAreErrorsOfTheWrite) {
  EXPECT_EXIT(
      {
        install_signal_handlers();
        exit_with(write_to_broken_pipe_fails() && write_over_the_limit_fails());
      },
      testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace bodyscan
