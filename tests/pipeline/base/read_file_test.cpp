#include "pipeline/base/read_file.hpp"

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>

namespace bodyscan {
namespace {

class ReadFile : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_);
    std::ofstream(path_) << "0123456789";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  const std::filesystem::path folder_ = std::filesystem::path(testing::TempDir()) / "bodyscan_read_file";
  const std::filesystem::path path_ = folder_ / "digits";
};

TEST_F(ReadFile, GivesAllBytesUpToTheLimit) {
  const auto bytes = read_file(path_, 10);
  ASSERT_TRUE(bytes) << bytes.error().message;
  EXPECT_EQ(as_text(*bytes), "0123456789");
  const auto over = read_file(path_, 9);
  ASSERT_FALSE(over);
  EXPECT_EQ(over.error().message, path_.string() + ": 10 bytes, over the limit of 9");
  EXPECT_EQ(over.error().kind, ErrorKind::input);
}

TEST_F(ReadFile, UsesMemoryAgain) {
  std::vector<std::byte> bytes(4096);
  const std::byte* memory = bytes.data();
  ASSERT_TRUE(read_file_into(path_, 100, bytes));
  EXPECT_EQ(as_text(bytes), "0123456789");
  EXPECT_EQ(bytes.data(), memory);
}

TEST_F(ReadFile, GivesTheStart) {
  EXPECT_EQ(as_text(read_file_start(path_, 4).value()), "0123");
  EXPECT_EQ(as_text(read_file_start(path_, 400).value()), "0123456789");
}

TEST_F(ReadFile, NamesTheFileAndTheReason) {
  const std::string missing = (folder_ / "nothing").string();
  EXPECT_EQ(read_file(missing, 10).error().message, missing + ": No such file or directory");
  EXPECT_EQ(read_file(folder_, 10).error().message, folder_.string() + ": not a regular file");
  const std::string pipe = (folder_ / "pipe").string();
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(read_file_start(pipe, 10).error().message, pipe + ": not a regular file");
}

}  // namespace
}  // namespace bodyscan
