#include "camera_test_support.hpp"

namespace bodyscan::simulator {
namespace {

using ptp::Operation;
using ptp::ResponseCode;
using std::chrono::milliseconds;

template <FaultKind kind, int shot>
class FaultyCameraTest : public CameraTest {
 protected:
  FaultyCameraTest() : CameraTest({{kind, shot, kind == FaultKind::move ? 2.0 : 0.0}}) {}
};

using SlowCamera = FaultyCameraTest<FaultKind::slow, 0>;
TEST_F(SlowCamera, DeliversASecondLate) {
  code(Operation::nikon_initiate_capture_rec_in_sdram);
  pass(milliseconds(50));
  EXPECT_EQ(camera_.next_due(), now_ + milliseconds(1000));
  pass(milliseconds(999));
  EXPECT_TRUE(queued_events().empty());
  pass(milliseconds(1));
  EXPECT_EQ(queued_events().size(), 2U);
}

using FrozenCamera = FaultyCameraTest<FaultKind::frozen, 2>;
TEST_F(FrozenCamera, AnswersNothingUntilANewConnection) {
  shoot();
  EXPECT_EQ(execute(Operation::nikon_initiate_capture_rec_in_sdram), std::nullopt);
  pass(std::chrono::hours(1));
  EXPECT_EQ(execute(Operation::nikon_device_ready), std::nullopt);
  EXPECT_EQ(execute(Operation::get_device_info), std::nullopt);
  reconnect();
  EXPECT_EQ(shoot(), "shot 3");
}

using DeadCamera = FaultyCameraTest<FaultKind::frozen_for_good, 1>;
TEST_F(DeadCamera, NeverAnswersAgain) {
  EXPECT_EQ(execute(Operation::nikon_initiate_capture_rec_in_sdram), std::nullopt);
  EXPECT_FALSE(camera_.connect());
  EXPECT_EQ(execute(Operation::get_device_info), std::nullopt);
}

using DisconnectingCamera = FaultyCameraTest<FaultKind::disconnect, 1>;
TEST_F(DisconnectingCamera, HangsUpInMidExposureOnce) {
  code(Operation::nikon_initiate_capture_rec_in_sdram);
  pass(milliseconds(24));
  EXPECT_FALSE(camera_.take_disconnection());
  pass(milliseconds(1));
  EXPECT_TRUE(camera_.take_disconnection());
  EXPECT_FALSE(camera_.take_disconnection());
  reconnect();
  EXPECT_EQ(shoot(), "shot 2");
  EXPECT_FALSE(camera_.take_disconnection());
}

using StaleCamera = FaultyCameraTest<FaultKind::stale, 2>;
TEST_F(StaleCamera, RepeatsOnePicture) {
  EXPECT_EQ(shoot(), "shot 1");
  EXPECT_EQ(shoot(), "shot 1");
  EXPECT_EQ(shoot(), "shot 3");
}

using LateCamera = FaultyCameraTest<FaultKind::late, 3>;
TEST_F(LateCamera, IsOnePictureBehindFromThenOn) {
  EXPECT_EQ(shoot(), "shot 1");
  EXPECT_EQ(shoot(), "shot 2");
  EXPECT_EQ(shoot(), "shot 2");
  EXPECT_EQ(shoot(), "shot 3");
  EXPECT_EQ(shoot(), "shot 4");
}

using OverexposingCamera = FaultyCameraTest<FaultKind::exposure, 2>;
TEST_F(OverexposingCamera, GetsFourTimesTheLightOnce) {
  shoot();
  shoot();
  shoot();
  EXPECT_EQ(darkroom_.exposures[0].gain, 1);
  EXPECT_EQ(darkroom_.exposures[1].gain, 4);
  EXPECT_EQ(darkroom_.exposures[2].gain, 1);
}

using MovingSubject = FaultyCameraTest<FaultKind::move, 2>;
TEST_F(MovingSubject, StandsElsewhereFromThenOn) {
  shoot();
  shoot();
  shoot();
  EXPECT_EQ(darkroom_.exposures[0].displacement, 0);
  EXPECT_EQ(darkroom_.exposures[1].displacement, 2);
  EXPECT_EQ(darkroom_.exposures[2].displacement, 2);
}

using CameraOffManual = FaultyCameraTest<FaultKind::dial, 0>;
TEST_F(CameraOffManual, LetsNobodySetTheShutter) {
  const std::optional<ptp::Response> response = execute(
      Operation::set_device_prop_value, {static_cast<std::uint32_t>(ptp::PropertyCode::nikon_exposure_time)},
      ptp::encode(std::uint32_t{1 << 16 | 60}));
  EXPECT_EQ(response->code, ResponseCode::access_denied);
  EXPECT_EQ(shoot(), "shot 1");
}

}  // namespace
}  // namespace bodyscan::simulator
