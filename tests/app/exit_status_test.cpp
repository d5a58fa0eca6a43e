#include "app/exit_status.hpp"

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

TEST(ExitStatus, FollowsTheKindOfError) {
  const auto status = [](ErrorKind kind) { return static_cast<int>(exit_status_of(kind)); };
  EXPECT_EQ(status(ErrorKind::usage), 2);
  EXPECT_EQ(status(ErrorKind::input), 3);
  EXPECT_EQ(status(ErrorKind::output), 3);
  EXPECT_EQ(status(ErrorKind::device), 4);
  EXPECT_EQ(status(ErrorKind::store), 5);
  EXPECT_EQ(status(ErrorKind::quality), 6);
  EXPECT_EQ(static_cast<int>(ExitStatus::done), 0);
}

}  // namespace
}  // namespace bodyscan
