#pragma once

#include "hal/replay/capture_manifest.hpp"
#include "pipeline/image/codec.hpp"
#include "pipeline/pattern/sequence.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_files.hpp"

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

namespace bodyscan {

// A folder with a small capture of 8 x 4 pixels, rows only; frame i in decode order is uniformly of value 10
// i.
class CaptureFixture : public testing::Test {
 protected:
  void SetUp() override {
    const PatternSequence sequence = make_sequence({16, 64}).value();
    manifest_.projector = sequence.projector;
    for (const Pattern& pattern : sequence.patterns) {
      const std::string name = "frame_" + std::to_string(manifest_.frames.size()) + ".png";
      manifest_.frames.push_back({name, pattern, {}});
      write_image(name, GrayImage8(frame_size, value(static_cast<int>(manifest_.frames.size()) - 1)));
    }
    ASSERT_TRUE(write_manifest(manifest_, folder_ / "capture.json"));
  }

  static std::uint8_t value(int index) { return static_cast<std::uint8_t>(10 * index); }

  template <class Pixel>
  void write_image(const std::string& name, const Image<Pixel>& image) const {
    write_bytes(folder_ / name, encode_png(image).value());
  }

  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }

  static constexpr Size frame_size{8, 4};
  TemporaryFolder temporary_;
  const std::filesystem::path folder_ = temporary_.path();
  CaptureManifest manifest_;
};

}  // namespace bodyscan
