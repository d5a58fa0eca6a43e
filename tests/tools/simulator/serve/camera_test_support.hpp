#pragma once

#include "tools/simulator/serve/camera.hpp"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace bodyscan::simulator {

// Develops at once, or when told to; each photo's JPEG is the text "shot N".
class FakeDarkroom final : public Darkroom {
 public:
  void shutter_opened(int shot, Moment) override { opened.push_back(shot); }
  void develop(const Exposure& exposure) override { exposures.push_back(exposure); }
  std::optional<Photo> take_photo() override {
    if (holds_back || taken_ == exposures.size()) return std::nullopt;
    return photo_of(exposures[taken_++].shot);
  }
  void develop_preview(const Exposure& exposure) override { previews.push_back(exposure); }
  SharedBytes take_preview() override {
    if (holds_back) return nullptr;
    return text("preview");
  }

  static SharedBytes text(const std::string& text) {
    return std::make_shared<const ptp::Bytes>(text.begin(), text.end());
  }
  static Photo photo_of(int shot) {
    return {text("shot " + std::to_string(shot)), {2144, 1424}, text("thumbnail"), {160, 106}};
  }

  bool holds_back = false;
  std::vector<int> opened;
  std::vector<Exposure> exposures;
  std::vector<Exposure> previews;

 private:
  std::size_t taken_ = 0;
};

// A camera whose time goes on when the test says so, with a session open.
class CameraTest : public testing::Test {
 protected:
  explicit CameraTest(std::vector<Fault> faults = {})
      : camera_({2144, 1424}, Faults(std::move(faults)), darkroom_) {
    reconnect();
  }

  void reconnect() {
    EXPECT_TRUE(camera_.connect());
    EXPECT_EQ(code(ptp::Operation::open_session, {1}), ptp::ResponseCode::ok);
  }
  std::optional<ptp::Response> execute(ptp::Operation operation, std::array<std::uint32_t, 5> parameters = {},
                                       ptp::Bytes data = {}) {
    return camera_.execute({operation, 1, parameters, std::move(data)}, now_);
  }
  // The answer's code; general_error from a frozen camera.
  ptp::ResponseCode code(ptp::Operation operation, std::array<std::uint32_t, 5> parameters = {}) {
    const std::optional<ptp::Response> response = execute(operation, parameters);
    return response ? response->code : ptp::ResponseCode::general_error;
  }
  std::string data(ptp::Operation operation, std::array<std::uint32_t, 5> parameters = {}) {
    const std::optional<ptp::Response> response = execute(operation, parameters);
    if (!response || !response->data) return "nothing";
    return {response->data->begin(), response->data->end()};
  }
  void pass(Clock::duration time) {
    now_ += time;
    camera_.advance(now_);
  }

  std::vector<ptp::EventCode> queued_events() {
    const std::optional<ptp::Response> response = execute(ptp::Operation::nikon_get_event);
    std::vector<ptp::EventCode> codes;
    if (!response) return codes;
    ptp::DatasetReader reader(*response->data);
    const int count = reader.get<std::uint16_t>().value();
    for (int i = 0; i < count; ++i) {
      codes.push_back(reader.get<ptp::EventCode>().value());
      reader.get<std::uint32_t>();
    }
    return codes;
  }
  // Shoots into RAM and waits for the picture's text.
  std::string shoot() {
    EXPECT_EQ(code(ptp::Operation::nikon_initiate_capture_rec_in_sdram), ptp::ResponseCode::ok);
    pass(std::chrono::milliseconds(50));
    EXPECT_EQ(queued_events().size(), 2U);
    return data(ptp::Operation::get_object, {ObjectStore::ram_handle});
  }

  FakeDarkroom darkroom_;
  Moment now_ = Moment() + std::chrono::hours(1);
  Camera camera_;
};

}  // namespace bodyscan::simulator
