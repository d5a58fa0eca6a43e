#include "process.hpp"
#include "synthetic_capture.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_files.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

namespace fs = std::filesystem;

struct BadInput {
  std::string name;
  std::function<void(const fs::path&)> damage;  // of a sound capture folder
  std::vector<std::string> message;             // what standard error must hold, file and reason
};

void PrintTo(const BadInput& input, std::ostream* stream) {
  *stream << input.name;
}

void truncate_to_half(const fs::path& file) {
  fs::resize_file(file, fs::file_size(file) / 2);
}

const std::vector<BadInput> bad_inputs = {
    {"no_folder", [](const fs::path& capture) { fs::remove_all(capture); }, {"capture.json"}},
    {"no_manifest", [](const fs::path& capture) { fs::remove(capture / "capture.json"); }, {"capture.json"}},
    {"manifest_is_no_json",
     [](const fs::path& capture) { write_text(capture / "capture.json", "{\"format\": "); },
     {"capture.json"}},
    {"another_format",
     [](const fs::path& capture) { replace_in(capture / "capture.json", "bodyscan-capture", "holiday"); },
     {"capture.json", "format"}},
    {"missing_frame",
     [](const fs::path& capture) { fs::remove(capture / "frame_05.png"); },
     {"frame_05.png", "No such file"}},
    {"frame_of_another_size",
     [](const fs::path& capture) {
       write_photograph(capture / "frame_04.png", {PatternKind::gray, Axis::row, 3, false}, {80, 60});
     },
     {"frame_04.png", "80 x 60", "160 x 120"}},
    {"truncated_frame",
     [](const fs::path& capture) { truncate_to_half(capture / "frame_06.png"); },
     {"frame_06.png"}},
    {"empty_frame",
     [](const fs::path& capture) { fs::resize_file(capture / "frame_06.png", 0); },
     {"frame_06.png"}},
    {"text_as_frame",
     [](const fs::path& capture) { write_text(capture / "frame_07.png", "this is no photograph\n"); },
     {"frame_07.png"}},
    {"frame_is_a_folder",
     [](const fs::path& capture) {
       fs::remove(capture / "frame_07.png");
       fs::create_directory(capture / "frame_07.png");
     },
     {"frame_07.png"}},
    {"file_name_leaves_the_folder",
     [](const fs::path& capture) {
       replace_in(capture / "capture.json", "frame_03.png", "../capture/frame_03.png");
     },
     {"capture.json", "frames[3].file"}},
    {"duplicate_bit",
     [](const fs::path& capture) {
       replace_in(capture / "capture.json", "\"frame_02.png\"", "\"frame_04.png\"");
       write_text(capture / "capture.json", [text = read_text(capture / "capture.json")]() mutable {
         const std::size_t place = text.find("\"bit\": 3");
         return place == std::string::npos ? text : text.replace(place, 8, "\"bit\": 4");
       }());
     },
     {"capture.json", "frames["}},
    {"missing_bit",
     [](const fs::path& capture) {
       replace_in(capture / "capture.json", "\"height\": 24", "\"height\": 48");
     },
     {"capture.json", "row"}},
    {"calibration_for_another_projector",
     [](const fs::path& capture) {
       replace_in(capture / "calibration.yml", "projector_size: [ 32, 24 ]", "projector_size: [ 64, 24 ]");
     },
     {"calibration.yml", "projector", "64 x 24", "32 x 24"}},
    {"calibration_for_another_resolution",
     [](const fs::path& capture) {
       replace_in(capture / "calibration.yml", "camera_size: [ 160, 120 ]", "camera_size: [ 320, 240 ]");
     },
     {"calibration.yml", "camera", "320 x 240", "160 x 120"}},
    {"no_calibration",
     [](const fs::path& capture) { fs::remove(capture / "calibration.yml"); },
     {"calibration.yml", "No such file"}},
    {"calibration_is_no_yaml",
     [](const fs::path& capture) { write_text(capture / "calibration.yml", "\x01\x02 rubbish"); },
     {"calibration.yml"}},
    {"nan_in_a_matrix",
     [](const fs::path& capture) { replace_in(capture / "calibration.yml", "175", ".Nan"); },
     {"calibration.yml", "camera_matrix"}},
    {"nothing_lit",
     [](const fs::path& capture) {
       fs::copy_file(capture / "frame_01.png", capture / "frame_00.png",
                     fs::copy_options::overwrite_existing);
     },
     {"lit"}},
    {"white_darker_than_black",
     [](const fs::path& capture) {
       fs::rename(capture / "frame_00.png", capture / "other.png");
       fs::rename(capture / "frame_01.png", capture / "frame_00.png");
       fs::rename(capture / "other.png", capture / "frame_01.png");
     },
     {"white", "black"}},
};

class BadInputs : public testing::TestWithParam<BadInput> {};

TEST_P(BadInputs, AreNamedWithExitStatus3AndNothingIsWritten) {
  const TemporaryFolder folder;
  const fs::path capture = folder.path() / "capture";
  const fs::path results = folder.path() / "results";
  fs::create_directory(capture);
  fs::create_directory(results);
  write_small_capture(capture);
  write_text(results / "model.wrl", "the model of last time");
  GetParam().damage(capture);
  const auto before = snapshot(folder.path());

  const ProcessResult run = run_bodyscan(
      {"reconstruct", capture, "--calibration", capture / "calibration.yml", "--output",
       results / "model.wrl", "--report", results / "report.json", "--preview", results / "preview.png"});

  EXPECT_EQ(run.status, 3) << run.error;
  EXPECT_EQ(run.output, "");
  EXPECT_TRUE(run.error.starts_with("bodyscan: ")) << run.error;
  EXPECT_EQ(std::count(run.error.begin(), run.error.end(), '\n'), 1) << run.error;
  for (const std::string& part : GetParam().message)
    EXPECT_NE(run.error.find(part), std::string::npos) << "no \"" << part << "\" in: " << run.error;
  EXPECT_EQ(snapshot(folder.path()), before);
}

INSTANTIATE_TEST_SUITE_P(Table, BadInputs, testing::ValuesIn(bad_inputs),
                         [](const auto& input) { return input.param.name; });

}  // namespace
}  // namespace bodyscan
