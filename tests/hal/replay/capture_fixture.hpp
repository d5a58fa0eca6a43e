#pragma once

#include "hal/replay/capture_manifest.hpp"
#include "pipeline/image/codec.hpp"
#include "pipeline/pattern/sequence.hpp"

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
    std::filesystem::create_directories(folder_);
    const PatternSequence sequence = make_sequence({16, 64}).value();
    manifest_.projector = sequence.projector;
    for (const Pattern& pattern : sequence.patterns) {
      const std::string name = "frame_" + std::to_string(manifest_.frames.size()) + ".png";
      manifest_.frames.push_back({name, pattern, {}});
      write_image(name, GrayImage8(frame_size, value(static_cast<int>(manifest_.frames.size()) - 1)));
    }
    ASSERT_TRUE(write_manifest(manifest_, folder_ / "capture.json"));
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  static std::uint8_t value(int index) { return static_cast<std::uint8_t>(10 * index); }

  template <class Pixel>
  void write_image(const std::string& name, const Image<Pixel>& image) const {
    write_bytes(name, encode_png(image).value());
  }

  void write_bytes(const std::string& name, std::span<const std::byte> bytes) const {
    std::ofstream(folder_ / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }

  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }

  static constexpr Size frame_size{8, 4};
  const std::filesystem::path folder_ = std::filesystem::path(testing::TempDir()) / "bodyscan_capture";
  CaptureManifest manifest_;
};

}  // namespace bodyscan
