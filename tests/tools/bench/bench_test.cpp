#include "tools/bench/child_process.hpp"
#include "tools/bench/link_capture.hpp"
#include "tools/bench/markdown.hpp"
#include "tools/bench/scenes.hpp"

#include <fstream>
#include <iterator>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace bodyscan {
namespace {

namespace fs = std::filesystem;

class Bench : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  static std::string read(const fs::path& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  fs::path folder_ = fs::path(testing::TempDir()) / ("bodyscan_bench_" + std::to_string(getpid()));
};

TEST_F(Bench, TablesAndNumbers) {
  EXPECT_EQ(markdown_table({{"a", "b"}, {"1", "2"}}), "| a | b |\n| --- | --- |\n| 1 | 2 |\n");
  EXPECT_EQ(fixed(1.25, 3), "1.250");
}

TEST_F(Bench, ASectionIsReplacedAndTheRestStays) {
  const fs::path file = folder_ / "tables.md";
  std::ofstream(file) << "# Tables\n";
  ASSERT_TRUE(replace_section(file, "speed", "old\n"));
  ASSERT_TRUE(replace_section(file, "growth", "other\n"));
  ASSERT_TRUE(replace_section(file, "speed", "new\n"));
  EXPECT_EQ(read(file),
            "# Tables\n\n<!-- bench: speed -->\nnew\n<!-- end: speed -->\n\n<!-- bench: growth -->\nother\n"
            "<!-- end: growth -->\n");
  EXPECT_FALSE(replace_section(folder_ / "no" / "folder.md", "speed", "new\n"));
}

TEST_F(Bench, AChildsUsageIsItsOwn) {
  const fs::path output = folder_ / "out";
  const Expected<ProcessUsage> usage = run_program({"sh", "-c", "sleep 0.05; echo hello; exit 7"}, output);
  ASSERT_TRUE(usage);
  EXPECT_EQ(usage->exit_status, 7);
  EXPECT_GE(usage->wall_s, 0.05);
  EXPECT_LT(usage->cpu_s, usage->wall_s);
  EXPECT_GT(usage->peak_memory_mb, 0.5);
  EXPECT_EQ(read(output), "hello\n");
  const Expected<ProcessUsage> killed = run_program({"sh", "-c", "kill -9 $$"});
  ASSERT_TRUE(killed);
  EXPECT_EQ(killed->exit_status, 137);
  EXPECT_FALSE(run_program({"no-such-program-here"}));
}

TEST_F(Bench, LinkedCapturesLeaveTheColumnsOut) {
  const fs::path capture = folder_ / "both";
  fs::create_directories(capture);
  std::ofstream(capture / "capture.json")
      << R"({"format": "bodyscan-capture", "frames": [{"file": "w.png", "pattern": "white"},)"
      << R"({"file": "r.png", "pattern": "gray", "axis": "row"},)"
      << R"({"file": "c.png", "pattern": "gray", "axis": "column"}]})";
  for (const char* file : {"w.png", "r.png", "c.png", "calibration.yml"})
    std::ofstream(capture / file) << file;
  ASSERT_TRUE(link_capture(capture, folder_ / "rows", true));
  EXPECT_EQ(read(folder_ / "rows" / "r.png"), "r.png");
  EXPECT_EQ(read(folder_ / "rows" / "calibration.yml"), "calibration.yml");
  EXPECT_FALSE(fs::exists(folder_ / "rows" / "c.png"));
  const auto manifest = nlohmann::json::parse(read(folder_ / "rows" / "capture.json"));
  EXPECT_EQ(manifest.at("frames").size(), 2U);
  EXPECT_EQ(manifest.at("format"), "bodyscan-capture");

  ASSERT_TRUE(link_capture(capture, folder_ / "all", false));
  EXPECT_TRUE(fs::exists(folder_ / "all" / "c.png"));
  EXPECT_FALSE(link_capture(folder_ / "nowhere", folder_ / "none", true));
}

TEST_F(Bench, EverySceneCanBeRendered) {
  for (const BenchScene& scene : accuracy_scenes(0.25)) {
    EXPECT_TRUE(scene.options.check()) << scene.name;
    EXPECT_EQ(bench_scene(scene.name, 0.25)->title, scene.title);
  }
  EXPECT_TRUE(bench_scene("speed", 1)->options.sequence.columns);
  EXPECT_FALSE(bench_scene("growth", 1)->options.sequence.columns);
  EXPECT_FALSE(bench_scene("nothing", 1));
}

}  // namespace
}  // namespace bodyscan
