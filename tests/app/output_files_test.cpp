#include "app/output_files.hpp"

#include "pipeline/base/read_file.hpp"
#include "pipeline/image/codec.hpp"
#include "tests/support/temporary_folder.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

namespace fs = std::filesystem;

class OutputFiles : public testing::Test {
 protected:
  TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path();
};

TEST_F(OutputFiles, DistinctPathsPass) {
  EXPECT_TRUE(check_distinct(std::vector<fs::path>{folder_ / "a", folder_ / "b"},
                             std::vector<fs::path>{folder_ / "c"}));
}

TEST_F(OutputFiles, OneFileForTwoResultsIsAUsageError) {
  const auto result =
      check_distinct(std::vector<fs::path>{folder_ / "a", folder_ / "." / "a"}, std::vector<fs::path>{});
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::usage);
}

TEST_F(OutputFiles, AnInputIsNotOverwrittenThroughALinkEither) {
  std::ignore = OptionalOutput::create(folder_ / "input").and_then([](OptionalOutput output) {
    return output.commit();
  });
  fs::create_symlink("input", folder_ / "link");
  const auto result =
      check_distinct(std::vector<fs::path>{folder_ / "link"}, std::vector<fs::path>{folder_ / "input"});
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::usage);
  EXPECT_NE(result.error().message.find("link"), std::string::npos);
}

TEST_F(OutputFiles, NoPathMeansNothingIsWritten) {
  auto output = OptionalOutput::create({});
  ASSERT_TRUE(output);
  EXPECT_FALSE(output->wanted());
  EXPECT_TRUE(output->write("text"));
  EXPECT_TRUE(output->commit());
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(OutputFiles, PictureAppearsWhenCommitted) {
  const fs::path path = folder_ / "picture.png";
  auto output = OptionalOutput::create(path);
  ASSERT_TRUE(output);
  ASSERT_TRUE(output->write_png(ColorImage8({3, 2}, Rgb8{1, 2, 3})));
  EXPECT_FALSE(fs::exists(path));
  ASSERT_TRUE(output->commit());
  const auto file = read_file(path, 1000);
  ASSERT_TRUE(file);
  const auto picture = decode_color(*file);
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->size(), (Size{3, 2}));
  EXPECT_EQ((*picture)(2, 1), (Rgb8{1, 2, 3}));
}

TEST_F(OutputFiles, FileThatCannotBeWrittenIsKnownAtOnce) {
  const auto output = OptionalOutput::create(folder_ / "nowhere" / "report.json");
  ASSERT_FALSE(output);
  EXPECT_EQ(output.error().kind, ErrorKind::output);
  EXPECT_NE(output.error().message.find("nowhere/report.json"), std::string::npos);
}

TEST_F(OutputFiles, AFolderIsMadeWithItsParentsAndGoesWhileEmpty) {
  for (const fs::path& path : {folder_ / "a" / "b", folder_ / "a" / "b" / ""}) {
    {
      const auto made = OutputFolder::create(path);
      ASSERT_TRUE(made) << made.error().message;
      EXPECT_TRUE(fs::is_directory(path));
    }
    EXPECT_TRUE(fs::is_empty(folder_));
  }
}

TEST_F(OutputFiles, AFolderStaysThatWasThereOrIsFilled) {
  fs::create_directory(folder_ / "there");
  {
    const auto there = OutputFolder::create(folder_ / "there");
    const auto filled = OutputFolder::create(folder_ / "filled");
    ASSERT_TRUE(there && filled);
    fs::create_directory(folder_ / "filled" / "result");
  }
  EXPECT_TRUE(fs::exists(folder_ / "there"));
  EXPECT_TRUE(fs::exists(folder_ / "filled" / "result"));
}

TEST_F(OutputFiles, AFolderThatCannotBeMadeIsAnOutputError) {
  std::ignore =
      OptionalOutput::create(folder_ / "file").and_then([](OptionalOutput file) { return file.commit(); });
  for (const fs::path& path : {folder_ / "file", folder_ / "file" / "sub" / "plots"}) {
    const auto made = OutputFolder::create(path);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().kind, ErrorKind::output);
    EXPECT_TRUE(made.error().message.starts_with(path.string() + ": ")) << made.error().message;
  }
}

}  // namespace
}  // namespace bodyscan
