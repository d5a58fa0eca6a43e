#include "camera_test_support.hpp"

namespace bodyscan::simulator {
namespace {

using ptp::EventCode;
using ptp::Operation;
using ptp::ResponseCode;
using std::chrono::milliseconds;

TEST_F(CameraTest, NeedsASessionForAllButItsDescription) {
  EXPECT_EQ(code(Operation::open_session, {2}), ResponseCode::session_already_open);
  EXPECT_EQ(code(Operation::close_session), ResponseCode::ok);
  EXPECT_EQ(code(Operation::get_device_info), ResponseCode::ok);
  EXPECT_EQ(code(Operation::get_storage_ids), ResponseCode::session_not_open);
  EXPECT_EQ(code(Operation::open_session, {0}), ResponseCode::invalid_parameter);
  EXPECT_EQ(code(Operation::open_session, {2}), ResponseCode::ok);
}

TEST_F(CameraTest, AnswersEveryOperationThatItAnnounces) {
  const ptp::Bytes info = *execute(Operation::get_device_info)->data;
  ptp::DatasetReader reader(info);
  reader.get<std::uint16_t>();
  EXPECT_EQ(reader.get<std::uint32_t>(), 10U);  // Nikon
  reader.get<std::uint16_t>();
  reader.text();
  reader.get<std::uint16_t>();
  const std::uint32_t count = reader.get<std::uint32_t>().value();
  ASSERT_GT(count, 25U);
  for (std::uint32_t i = 0; i < count; ++i) {
    const Operation operation = reader.get<Operation>().value();
    EXPECT_NE(code(operation), ResponseCode::operation_not_supported) << static_cast<int>(operation);
    camera_.connect();
    code(Operation::open_session, {1});
  }
  EXPECT_EQ(code(static_cast<Operation>(0x9207)), ResponseCode::operation_not_supported);  // no D5000 has it
}

TEST_F(CameraTest, AShotIntoRamIsBusyForItsExposureAndThenTellsByEvents) {
  EXPECT_EQ(code(Operation::nikon_device_ready), ResponseCode::ok);
  EXPECT_EQ(code(Operation::nikon_initiate_capture_rec_in_sdram), ResponseCode::ok);
  EXPECT_EQ(darkroom_.opened, std::vector{1});
  EXPECT_EQ(camera_.next_due(), now_ + milliseconds(50));
  pass(milliseconds(49));
  EXPECT_EQ(code(Operation::nikon_device_ready), ResponseCode::device_busy);
  EXPECT_EQ(code(Operation::nikon_af_capture_sdram), ResponseCode::device_busy);
  EXPECT_TRUE(queued_events().empty());
  pass(milliseconds(1));
  ASSERT_EQ(darkroom_.exposures.size(), 1U);
  EXPECT_EQ(darkroom_.exposures[0].end - darkroom_.exposures[0].begin, milliseconds(50));
  EXPECT_EQ(darkroom_.exposures[0].gain, 1);
  EXPECT_EQ(code(Operation::nikon_device_ready), ResponseCode::ok);
  EXPECT_EQ(queued_events(), (std::vector{EventCode::nikon_object_added_in_sdram,
                                          EventCode::nikon_capture_complete_rec_in_sdram}));
  EXPECT_TRUE(queued_events().empty());
  EXPECT_EQ(data(Operation::get_object, {ObjectStore::ram_handle}), "shot 1");
  EXPECT_EQ(code(Operation::nikon_del_image_sdram), ResponseCode::ok);
  EXPECT_EQ(code(Operation::get_object, {ObjectStore::ram_handle}), ResponseCode::invalid_object_handle);
}

TEST_F(CameraTest, AShotOntoTheCardTellsOnTheEventConnection) {
  EXPECT_EQ(code(Operation::initiate_capture), ResponseCode::ok);
  pass(milliseconds(50));
  EXPECT_TRUE(queued_events().empty());
  const std::vector<ptp::Event> events = camera_.take_events();
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].code, EventCode::object_added);
  EXPECT_EQ(events[1].code, EventCode::capture_complete);
  EXPECT_EQ(data(Operation::get_object, {events[0].parameter}), "shot 1");
  EXPECT_EQ(data(Operation::get_thumb, {events[0].parameter}), "thumbnail");
  EXPECT_EQ(execute(Operation::get_num_objects, {0xFFFFFFFF, 0x3801})->parameters,
            std::vector<std::uint32_t>{1});
  EXPECT_EQ(code(Operation::delete_object, {events[0].parameter}), ResponseCode::ok);
  EXPECT_EQ(code(Operation::delete_object, {events[0].parameter}), ResponseCode::invalid_object_handle);
  EXPECT_TRUE(camera_.take_events().empty());
}

TEST_F(CameraTest, PartsOfAnObjectEndWithIt) {
  shoot();
  const auto part = [&](std::uint32_t begin, std::uint32_t count) {
    return data(Operation::get_partial_object, {ObjectStore::ram_handle, begin, count});
  };
  EXPECT_EQ(part(0, 4), "shot");
  EXPECT_EQ(part(5, 100), "1");
  EXPECT_EQ(part(6, 1), "");
  EXPECT_EQ(part(7, 1), "nothing");
  EXPECT_EQ(execute(Operation::get_partial_object, {ObjectStore::ram_handle, 5, 0xFFFFFFFF})->parameters,
            std::vector<std::uint32_t>{1});
}

TEST_F(CameraTest, WhileThePictureDevelopsTheCameraIsReadyButTakesNoOther) {
  darkroom_.holds_back = true;
  code(Operation::nikon_initiate_capture_rec_in_sdram);
  pass(milliseconds(60));
  EXPECT_EQ(code(Operation::nikon_device_ready), ResponseCode::ok);
  EXPECT_EQ(code(Operation::nikon_initiate_capture_rec_in_sdram), ResponseCode::device_busy);
  EXPECT_TRUE(queued_events().empty());
  darkroom_.holds_back = false;
  pass(milliseconds(1));
  EXPECT_EQ(queued_events().size(), 2U);
}

TEST_F(CameraTest, ItsSettingsMakeTheExposure) {
  execute(Operation::set_device_prop_value,
          {static_cast<std::uint32_t>(ptp::PropertyCode::nikon_exposure_time)},
          ptp::encode(std::uint32_t{1 << 16 | 10}));
  execute(Operation::set_device_prop_value, {static_cast<std::uint32_t>(ptp::PropertyCode::exposure_index)},
          ptp::encode(std::uint16_t{400}));
  code(Operation::nikon_initiate_capture_rec_in_sdram);
  pass(milliseconds(100));
  ASSERT_EQ(darkroom_.exposures.size(), 1U);
  EXPECT_EQ(darkroom_.exposures[0].end - darkroom_.exposures[0].begin, milliseconds(100));
  EXPECT_NEAR(darkroom_.exposures[0].gain, 4, 1e-9);
}

TEST_F(CameraTest, LiveViewGivesPicturesWhileItIsOn) {
  EXPECT_EQ(code(Operation::nikon_get_live_view_img), ResponseCode::nikon_not_live_view);
  EXPECT_EQ(code(Operation::nikon_start_live_view), ResponseCode::ok);
  darkroom_.holds_back = true;
  EXPECT_EQ(code(Operation::nikon_get_live_view_img), ResponseCode::device_busy);
  EXPECT_EQ(code(Operation::nikon_get_live_view_img), ResponseCode::device_busy);
  EXPECT_EQ(darkroom_.previews.size(), 1U);
  darkroom_.holds_back = false;
  EXPECT_EQ(data(Operation::nikon_get_live_view_img).substr(64), "preview");
  EXPECT_EQ(code(Operation::nikon_end_live_view), ResponseCode::ok);
  EXPECT_EQ(code(Operation::nikon_get_live_view_img), ResponseCode::nikon_not_live_view);
}

TEST_F(CameraTest, ANewInitiatorFindsItIdle) {
  code(Operation::nikon_initiate_capture_rec_in_sdram);
  reconnect();
  pass(milliseconds(100));
  EXPECT_TRUE(queued_events().empty());
  EXPECT_EQ(shoot(), "shot 2");
}

}  // namespace
}  // namespace bodyscan::simulator
