#include "pipeline/base/atomic_file.hpp"

#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_files.hpp"

#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>

namespace bodyscan {
namespace {

namespace fs = std::filesystem;

class AtomicFileTest : public testing::Test {
 protected:
  static void put(const fs::path& path, std::string_view text) {
    auto file = AtomicFile::create(path);
    ASSERT_TRUE(file) << file.error().message;
    ASSERT_TRUE(file->write(text));
    ASSERT_TRUE(file->commit(Durability::process));
  }
  [[nodiscard]] std::ptrdiff_t entries() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }
  static void expect_output_error(const Expected<AtomicFile>& file, const std::string& message) {
    ASSERT_FALSE(file);
    EXPECT_EQ(file.error().kind, ErrorKind::output);
    EXPECT_EQ(file.error().message, message);
  }

  TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path();
};

TEST_F(AtomicFileTest, AppearsWithCommit) {
  for (const Durability durability : {Durability::process, Durability::power_cut}) {
    const fs::path path = folder_ / std::to_string(static_cast<int>(durability));
    auto file = AtomicFile::create(path);
    ASSERT_TRUE(file && file->write("one ") && file->write("two"));
    EXPECT_FALSE(fs::exists(path));
    ASSERT_TRUE(file->commit(durability));
    EXPECT_EQ(read_text(path), "one two");
  }
  EXPECT_EQ(entries(), 2);
}

TEST_F(AtomicFileTest, LeavesNothingWithoutCommit) {
  put(folder_ / "file", "old");
  {
    auto file = AtomicFile::create(folder_ / "file");
    ASSERT_TRUE(file && file->write("new"));
    EXPECT_EQ(entries(), 2);
  }
  EXPECT_EQ(entries(), 1);
  EXPECT_EQ(read_text(folder_ / "file"), "old");
}

TEST_F(AtomicFileTest, ReplacesTheOldFileAtOnce) {
  put(folder_ / "file", "old");
  auto file = AtomicFile::create(folder_ / "file");
  ASSERT_TRUE(file && file->write("new"));
  EXPECT_EQ(read_text(folder_ / "file"), "old");
  ASSERT_TRUE(file->commit(Durability::process));
  EXPECT_EQ(read_text(folder_ / "file"), "new");
}

TEST_F(AtomicFileTest, LetsTwoWritersOfOneNameFinish) {
  auto first = AtomicFile::create(folder_ / "file");
  auto second = AtomicFile::create(folder_ / "file");
  ASSERT_TRUE(first && second && first->write("first") && second->write("second"));
  ASSERT_TRUE(first->commit(Durability::process));
  ASSERT_TRUE(second->commit(Durability::process));
  EXPECT_EQ(read_text(folder_ / "file"), "second");
}

TEST_F(AtomicFileTest, MovesItsFile) {
  auto first = AtomicFile::create(folder_ / "first");
  auto second = AtomicFile::create(folder_ / "second");
  ASSERT_TRUE(first && second && second->write("2"));
  AtomicFile moved = std::move(*first);
  EXPECT_EQ(entries(), 2);
  moved = std::move(*second);
  EXPECT_EQ(entries(), 1);
  ASSERT_TRUE(moved.commit(Durability::process));
  EXPECT_EQ(read_text(folder_ / "second"), "2");
}

TEST_F(AtomicFileTest, FollowsSymbolicLinks) {
  fs::create_directory(folder_ / "elsewhere");
  put(folder_ / "elsewhere/file", "old");
  fs::create_symlink(folder_ / "elsewhere/file", folder_ / "link");
  put(folder_ / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(read_text(folder_ / "elsewhere/file"), "new");
}

TEST_F(AtomicFileTest, WritesDevicesAndPipesInPlace) {
  put("/dev/null", "nowhere");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  auto full = AtomicFile::create("/dev/full");
  ASSERT_TRUE(full);
  const auto written = full->write("x");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, ErrorKind::output);
  EXPECT_EQ(written.error().message, "/dev/full: cannot write: No space left on device");
}

TEST_F(AtomicFileTest, HasTheUsualPermissions) {
  const mode_t before = ::umask(027);
  put(folder_ / "file", "text");
  ::umask(before);
  struct stat status {};
  ASSERT_EQ(::stat((folder_ / "file").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0640U);
}

TEST_F(AtomicFileTest, WorksInTheCurrentFolder) {
  const fs::path before = fs::current_path();
  fs::current_path(folder_);
  auto file = AtomicFile::create("file");
  const bool done = file && file->write("here") && file->commit(Durability::power_cut);
  fs::current_path(before);
  EXPECT_TRUE(done);
  EXPECT_EQ(read_text(folder_ / "file"), "here");
}

TEST_F(AtomicFileTest, NamesTheFileAndTheReason) {
  const std::string name = folder_.string();
  expect_output_error(AtomicFile::create(folder_ / "no/file"),
                      name + "/no/file: cannot create: No such file or directory");
  expect_output_error(AtomicFile::create(folder_), name + ": cannot write: Is a directory");
  expect_output_error(AtomicFile::create(""), ": cannot write: Invalid argument");
  expect_output_error(AtomicFile::create(folder_ / "new" / ""),
                      name + "/new/: cannot write: Invalid argument");
  put(folder_ / "file", "");
  expect_output_error(AtomicFile::create(folder_ / "file/file"),
                      name + "/file/file: cannot create: Not a directory");
}

TEST_F(AtomicFileTest, TellsWhenItsFolderWentAway) {
  fs::create_directory(folder_ / "short");
  auto file = AtomicFile::create(folder_ / "short/file");
  ASSERT_TRUE(file && file->write("x"));
  fs::remove_all(folder_ / "short");
  const auto committed = file->commit(Durability::process);
  ASSERT_FALSE(committed);
  EXPECT_EQ(committed.error().message,
            (folder_ / "short/file").string() + ": cannot rename: No such file or directory");
}

}  // namespace
}  // namespace bodyscan
