#include "reference.hpp"

#include "running_scan.hpp"
#include "station.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace bodyscan {

Reference::Reference(int displacement_mm) {
  const std::filesystem::path capture = folder_ / "capture";
  std::vector<std::string> words{BODYSCAN_SIMULATOR, "render"};
  for (const std::string& option : scene_options()) words.push_back(option);
  words.insert(words.end(), {"--pose", "0,0,0," + std::to_string(displacement_mm) + ",0,0", "--calibration",
                             "builtin:rows", "--projector", "256x192", "--output", capture});
  run_program(words);
  run_program({BODYSCAN_EXECUTABLE, "reconstruct", capture, "--calibration", capture / "calibration.yml",
               "--output", folder_ / "model.wrl"});
  const Expected<Evaluation> evaluation = evaluate_files(folder_ / "model.wrl", capture);
  EXPECT_TRUE(evaluation) << evaluation.error().message;
  if (evaluation) evaluation_ = *evaluation;
}

void Reference::expect_as_good(const std::filesystem::path& model) const {
  const Expected<Evaluation> evaluation = evaluate_files(model, folder_ / "capture");
  ASSERT_TRUE(evaluation) << evaluation.error().message;
  const auto wanted = static_cast<double>(evaluation_.points);
  EXPECT_GT(wanted, 10'000);
  EXPECT_NEAR(static_cast<double>(evaluation->points), wanted, 0.01 * wanted);
  // Noise differs, and with it the figures by a few hundredths.
  EXPECT_LT(evaluation->deviation.rms, 1.05 * evaluation_.deviation.rms);
  EXPECT_NEAR(evaluation->deviation.bias, evaluation_.deviation.bias, 0.1 * evaluation_.deviation.rms);
  EXPECT_LT(evaluation->share_wrong, evaluation_.share_wrong + 0.001);
}

const Reference& reference() {
  static const Reference made;
  return made;
}

const Reference& displaced_reference() {
  static const Reference made(2);
  return made;
}

}  // namespace bodyscan
