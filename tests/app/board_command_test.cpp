#include "app/command_line.hpp"
#include "pipeline/base/read_file.hpp"
#include "tests/support/temporary_folder.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

namespace fs = std::filesystem;

class BoardCommand : public testing::Test {
 protected:
  // `bodyscan board --columns 9 --rows 7 --square-mm 25 --output FOLDER/file`, each option replaced or added
  // to by the pairs of `options`.
  ExitStatus run(const std::string& file, const std::vector<std::string>& options = {}) {
    std::vector<std::string> words = {
        "bodyscan", "board",       "--columns", "9",        "--rows",
        "7",        "--square-mm", "25",        "--output", (folder_ / file).string()};
    for (std::size_t i = 0; i < options.size(); i += 2) {
      const auto old = std::find(words.begin(), words.end(), options[i]);
      if (old != words.end())
        *(old + 1) = options[i + 1];
      else
        words.insert(words.end(), {options[i], options[i + 1]});
    }
    std::vector<const char*> arguments;
    for (const std::string& word : words) arguments.push_back(word.c_str());
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const ExitStatus status = run_command_line(static_cast<int>(arguments.size()), arguments.data());
    output_ = testing::internal::GetCapturedStdout();
    error_ = testing::internal::GetCapturedStderr();
    return status;
  }
  [[nodiscard]] std::string content(const std::string& file) const {
    return std::string(as_text(read_file(folder_ / file, 1 << 20).value()));
  }

  TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path();
  std::string output_;
  std::string error_;
};

TEST_F(BoardCommand, WritesPdfOrSvgByTheName) {
  EXPECT_EQ(run("board.pdf"), ExitStatus::done) << error_;
  EXPECT_EQ(content("board.pdf").substr(0, 8), "%PDF-1.4");
  EXPECT_NE(output_.find("board.pdf: 297 x 210 mm, 5 mm of white"), std::string::npos) << output_;
  EXPECT_EQ(run("board.svg", {"--paper", "a2"}), ExitStatus::done) << error_;
  EXPECT_NE(content("board.svg").find("width=\"594mm\" height=\"420mm\""), std::string::npos);
  EXPECT_EQ(error_, "");
}

TEST_F(BoardCommand, TakesPaperOfAnySize) {
  EXPECT_EQ(run("board.svg", {"--paper", "300.5x400"}), ExitStatus::done) << error_;
  EXPECT_NE(content("board.svg").find("width=\"400mm\" height=\"300.5mm\""), std::string::npos);
}

TEST_F(BoardCommand, WhatDoesNotFitIsAUsageError) {
  EXPECT_EQ(run("board.pdf", {"--square-mm", "26"}), ExitStatus::usage);
  EXPECT_NE(error_.find("--paper: a board of 260 x 208 mm and its ruler need paper of"), std::string::npos)
      << error_;
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(BoardCommand, WrongValuesAreUsageErrors) {
  const std::vector<std::pair<std::string, std::string>> values = {
      {"--columns", "2"},     {"--columns", "101"},   {"--rows", "7.5"},        {"--rows", "many"},
      {"--square-mm", "0"},   {"--square-mm", "-1"},  {"--square-mm", "1000"},  {"--square-mm", "nan"},
      {"--output", "b.png"},  {"--output", "b"},      {"--paper", "a5"},        {"--paper", "300"},
      {"--paper", "300x"},    {"--paper", "0x300"},   {"--paper", "300x400mm"}, {"--paper", "nanx300"},
      {"--paper", "300xnan"}, {"--paper", "infx300"}, {"--paper", "300xinf"},   {"--paper", "300x6000"},
      {"--colour", "red"},
  };
  for (const auto& [option, value] : values) {
    EXPECT_EQ(run("board.pdf", {option, value}), ExitStatus::usage) << option << " " << value;
    EXPECT_NE(error_.find(option), std::string::npos) << error_;
    EXPECT_EQ(output_, "");
  }
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(BoardCommand, AFileThatCannotBeWrittenHasExitStatus3) {
  EXPECT_EQ(run("nowhere/board.pdf"), ExitStatus::file);
  EXPECT_NE(error_.find("nowhere/board.pdf"), std::string::npos) << error_;
}

}  // namespace
}  // namespace bodyscan
