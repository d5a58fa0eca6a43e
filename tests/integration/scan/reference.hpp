#pragma once

#include "tests/support/temporary_folder.hpp"
#include "tools/evaluate/evaluation.hpp"

#include <filesystem>

namespace bodyscan {

// The scene's model as `reconstruct` makes it of rendered photographs.
class Reference {
 public:
  // The subject stands so far along the camera's x from its place.
  explicit Reference(int displacement_mm = 0);

  // That a model is as good as the reference, judged by the truth.
  void expect_as_good(const std::filesystem::path& model) const;

 private:
  TemporaryFolder folder_;
  Evaluation evaluation_;
};

// Made once.
const Reference& reference();
const Reference& displaced_reference();  // by 2 mm

}  // namespace bodyscan
