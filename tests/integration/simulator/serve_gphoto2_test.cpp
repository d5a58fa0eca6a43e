#include "served_world.hpp"
#include "tests/tools/simulator/serve/projector_client.hpp"
#include "tools/simulator/image_files.hpp"

#include <chrono>
#include <csignal>
#include <filesystem>
#include <iterator>
#include <regex>
#include <thread>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

const std::vector<std::string> small_world{
    "--subject", "builtin:staircase", "--calibration", "builtin:rows", "--scale", "0.1", "--rays",
    "1",         "--projector-size",  "256x192"};

double mean_code(const std::filesystem::path& path) {
  const ColorImage8 image = simulator::read_color_image(path).value();
  double sum = 0;
  for (const Rgb8& pixel : image.pixels()) sum += pixel[1];
  return sum / static_cast<double>(image.size().area());
}

testing::AssertionResult holds(const std::string& output, const std::string& wanted) {
  if (output.find(wanted) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "no \"" << wanted << "\" in: " << output;
}

std::size_t entries(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(ServeGphoto2, TellsWhereItIsAndEndsCleanly) {
  for (const int signal : {SIGTERM, SIGINT}) {
    ServedWorld world(small_world);
    EXPECT_TRUE(std::regex_match(world.ready_line(),
                                 std::regex("ready ptpip:127\\.0\\.0\\.1:[0-9]+:[0-9]+ .*/projector")))
        << world.ready_line();
    EXPECT_TRUE(std::filesystem::exists(world.projector()));
    const Finished finished = world.end(signal);
    EXPECT_EQ(finished.status, 0);
    EXPECT_EQ(finished.output, "");
    EXPECT_FALSE(std::filesystem::exists(world.projector()));
  }
}

TEST(ServeGphoto2, SummaryAndConfigurationAreANikonD5000s) {
  ServedWorld world(small_world);
  const Finished summary = world.gphoto2({"--summary"});
  EXPECT_EQ(summary.status, 0);
  for (const char* wanted : {"Manufacturer: Nikon Corporation", "Model: D5000", "Nikon Capture 1",
                             "'429x285'", "value: f/8 (800)", "value: M (1)", "Free Space (Images): 200"})
    EXPECT_TRUE(holds(summary.output, wanted));
  const Finished configuration = world.gphoto2({"--list-config"});
  EXPECT_EQ(configuration.status, 0);
  for (const char* wanted :
       {"/main/settings/capturetarget", "/main/settings/autofocus", "/main/imgsettings/iso",
        "/main/imgsettings/imagesize", "/main/capturesettings/f-number", "/main/capturesettings/expprogram",
        "/main/capturesettings/shutterspeed2"})
    EXPECT_TRUE(holds(configuration.output, wanted));
  EXPECT_TRUE(
      holds(world.gphoto2({"--set-config", "shutterspeed2=1/15", "--get-config", "shutterspeed2"}).output,
            "Current: 1/15"));
}

TEST(ServeGphoto2, CapturesToRamWhatTheProjectorShows) {
  ServedWorld world(small_world);
  simulator::ProjectorClient projector(world.projector());
  projector.greet();
  projector.draw(0, 255);
  projector.flip(0, 1);
  // gphoto2 waits for two seconds after a capture whether there is more.
  const Finished captured = world.gphoto2(
      {"--set-config", "capturetarget=0", "--capture-image-and-download", "--filename", "white.jpg"});
  EXPECT_EQ(captured.status, 0) << captured.output;
  EXPECT_EQ(simulator::read_color_image(world.folder() / "white.jpg").value().size(), (Size{429, 285}));
  EXPECT_GT(mean_code(world.folder() / "white.jpg"), 40);
}

std::vector<std::string> with_fault(const std::string& fault) {
  std::vector<std::string> options = small_world;
  options.insert(options.end(), {"--fault", fault});
  return options;
}

TEST(ServeGphoto2, CapturesToTheCardWhileTheProjectorChangesItsMode) {
  ServedWorld world(with_fault("projector-mode@1"));
  simulator::ProjectorClient projector(world.projector());
  EXPECT_EQ(projector.greet().width, 256U);
  const Finished captured = world.gphoto2(
      {"--set-config", "capturetarget=1", "--capture-image-and-download", "--filename", "black.jpg"});
  EXPECT_EQ(captured.status, 0) << captured.output;
  EXPECT_TRUE(holds(captured.output, "DCIM/100D5000/DSC_0001.JPG"));
  EXPECT_EQ(simulator::read_color_image(world.folder() / "black.jpg").value().size(), (Size{429, 285}));
  EXPECT_LT(mean_code(world.folder() / "black.jpg"), 30);
  EXPECT_TRUE(projector.hung_up());
  EXPECT_EQ(simulator::ProjectorClient(world.projector()).greet().width, 800U);
}

TEST(ServeGphoto2, AShotUnplugsTheProjector) {
  ServedWorld world(with_fault("projector-gone@1"));
  simulator::ProjectorClient projector(world.projector());
  projector.greet();
  EXPECT_EQ(world.gphoto2({"--trigger-capture"}).status, 0);
  EXPECT_TRUE(projector.hung_up());
  EXPECT_FALSE(simulator::ProjectorClient(world.projector()).connected());
}

TEST(ServeGphoto2, OffManualTheShutterCannotBeSet) {
  ServedWorld world(with_fault("dial"));
  EXPECT_TRUE(holds(world.gphoto2({"--get-config", "expprogram"}).output, "Current: P"));
  EXPECT_TRUE(holds(world.gphoto2({"--get-config", "shutterspeed2"}).output, "Readonly: 1"));
  EXPECT_NE(world.gphoto2({"--set-config", "shutterspeed2=1/15"}).status, 0);
}

TEST(ServeGphoto2, NoThreadAndNoDescriptorStaysBehindAClient) {
  ServedWorld world(small_world);
  const std::filesystem::path process = "/proc/" + std::to_string(world.pid());
  EXPECT_EQ(world.gphoto2({"--capture-preview"}).status, 0);
  const std::size_t descriptors = entries(process / "fd");
  const std::size_t threads = entries(process / "task");
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(world.gphoto2({"--capture-preview", "--force-overwrite"}).status, 0);
    simulator::ProjectorClient(world.projector()).greet();
  }
  for (int i = 0; i < 100 && entries(process / "fd") > descriptors; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(entries(process / "fd"), descriptors);
  EXPECT_EQ(entries(process / "task"), threads);
}

}  // namespace
}  // namespace bodyscan
