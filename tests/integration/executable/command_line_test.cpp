#include "process.hpp"

#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

TEST(CommandLine, TellsItsVersionAndCommit) {
  const ProcessResult run = run_bodyscan({"--version"});
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.error, "");
  EXPECT_TRUE(
      std::regex_match(run.output, std::regex("bodyscan \\d+\\.\\d+\\.\\d+(\\+[0-9a-f]{10,}(-dirty)?)?\n")))
      << run.output;
}

TEST(CommandLine, HelpNamesCommandsAndExitStatuses) {
  const ProcessResult run = run_bodyscan({"--help"});
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.error, "");
  for (const char* part : {"reconstruct", "--version", "Exit status: 0 done, 2"})
    EXPECT_NE(run.output.find(part), std::string::npos) << run.output;
}

TEST(CommandLine, EveryCommandHasHelp) {
  const std::string commands = run_bodyscan({"--help"}).output;
  const std::size_t list = commands.find("Subcommands:\n");
  ASSERT_NE(list, std::string::npos) << commands;
  const std::string lines = commands.substr(list);
  const std::regex name("\n  ([a-z]+) ");
  int found = 0;
  for (std::sregex_iterator match(lines.begin(), lines.end(), name); match != std::sregex_iterator();
       ++match) {
    const ProcessResult run = run_bodyscan({(*match)[1], "--help"});
    EXPECT_EQ(run.status, 0) << (*match)[1];
    EXPECT_NE(run.output.find("Usage:"), std::string::npos) << run.output;
    ++found;
  }
  EXPECT_GE(found, 1) << lines;
}

TEST(CommandLine, ReconstructHelpNamesItsOptions) {
  const ProcessResult run = run_bodyscan({"reconstruct", "--help"});
  EXPECT_EQ(run.status, 0);
  for (const char* option : {"CAPTURE_DIR", "--calibration", "--output", "--report", "--preview", "--depth",
                             "--rows", "--max-error", "--json"})
    EXPECT_NE(run.output.find(option), std::string::npos) << option << " is not in " << run.output;
}

struct WrongLine {
  std::vector<std::string> arguments;
  std::string message;
};

TEST(CommandLine, WrongLinesHaveExitStatus2AndAMessage) {
  const std::vector<WrongLine> lines = {
      {{}, "a command is missing"},
      {{"dance"}, "dance"},
      {{"reconstruct"}, "CAPTURE_DIR"},
      {{"reconstruct", "folder", "--output", "model.wrl"}, "--calibration"},
      {{"reconstruct", "folder", "--calibration", "file"}, "--output"},
      {{"reconstruct", "folder", "--calibration", "file", "--output", "m.wrl", "--verbose"}, "--verbose"},
      {{"reconstruct", "folder", "--calibration", "file", "--output", "m.wrl", "--max-error", "much"},
       "--max-error"},
      {{"reconstruct", "folder", "--calibration", "file", "--output", "m.wrl", "--max-error", "-1"},
       "--max-error"},
      {{"reconstruct", "folder", "--calibration", "file", "--output", "m.wrl", "--max-error", "nan"},
       "--max-error"},
      {{"reconstruct", "folder", "--calibration", "file", "--output", "m.wrl", "--report", "./m.wrl"},
       "m.wrl"},
      {{"reconstruct", "folder", "--calibration", "file", "--output", "file"}, "file"},
  };
  for (const WrongLine& line : lines) {
    const ProcessResult run = run_bodyscan(line.arguments);
    EXPECT_EQ(run.status, 2) << line.message << ": " << run.error;
    EXPECT_EQ(run.output, "") << line.message;
    EXPECT_NE(run.error.find(line.message), std::string::npos) << line.message << ": " << run.error;
  }
}

}  // namespace
}  // namespace bodyscan
