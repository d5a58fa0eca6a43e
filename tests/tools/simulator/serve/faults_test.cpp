#include "tools/simulator/serve/faults.hpp"

#include <gtest/gtest.h>

namespace bodyscan::simulator {
namespace {

TEST(Faults, AreReadFromTheirText) {
  const Fault slow = parse_fault("slow").value();
  EXPECT_EQ(slow.kind, FaultKind::slow);
  const Fault frozen = parse_fault("frozen-for-good@3").value();
  EXPECT_EQ(frozen.kind, FaultKind::frozen_for_good);
  EXPECT_EQ(frozen.shot, 3);
  const Fault move = parse_fault("move=-2.5@12").value();
  EXPECT_EQ(move.kind, FaultKind::move);
  EXPECT_EQ(move.shot, 12);
  EXPECT_EQ(move.distance, -2.5);
}

TEST(Faults, WrongTextsAreUsageErrorsThatNameTheOption) {
  for (const char* text : {"", "fire", "slow@2", "dial@1", "frozen", "frozen@", "frozen@0", "frozen@x",
                           "frozen@2x", "frozen@-1", "stale@1", "late@1", "move@3", "move=@3", "move=a@3",
                           "move=nan@3", "move=1001@3", "exposure=4@3", "move=2"}) {
    const Expected<Fault> fault = parse_fault(text);
    ASSERT_FALSE(fault.has_value()) << text;
    EXPECT_EQ(fault.error().kind, ErrorKind::usage);
    EXPECT_TRUE(fault.error().message.starts_with("--fault: \"" + std::string(text) + "\": ")) << text;
  }
}

TEST(Faults, HoldAtTheirShotOrFromItOn) {
  const Faults faults({{FaultKind::stale, 3, 0}, {FaultKind::dial, 0, 0}});
  EXPECT_FALSE(faults.at(FaultKind::stale, 2));
  EXPECT_TRUE(faults.at(FaultKind::stale, 3));
  EXPECT_FALSE(faults.at(FaultKind::stale, 4));
  EXPECT_FALSE(faults.since(FaultKind::stale, 2));
  EXPECT_TRUE(faults.since(FaultKind::stale, 9));
  EXPECT_TRUE(faults.has(FaultKind::dial));
  EXPECT_FALSE(faults.has(FaultKind::slow));
}

TEST(Faults, TheLastMoveCounts) {
  const Faults faults({{FaultKind::move, 5, -1}, {FaultKind::move, 2, 2}});
  EXPECT_EQ(faults.displacement(1), 0);
  EXPECT_EQ(faults.displacement(2), 2);
  EXPECT_EQ(faults.displacement(4), 2);
  EXPECT_EQ(faults.displacement(7), -1);
  EXPECT_EQ(faults.displacements().size(), 2U);
}

}  // namespace
}  // namespace bodyscan::simulator
