// What may go wrong during a scan, by the simulator's faults.
#include "reference.hpp"
#include "station.hpp"

#include <atomic>
#include <chrono>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

// One fault, what it does to a scan, and what is then scanned on the same world.
struct Case {
  const char* fault;
  int status;
  const char* told;          // 0: in the report's lists; else: in standard error
  double most_seconds;       // of the scan
  int most_shots = 19;       // of the scan
  int next_status = 0;       // -1: nothing is scanned
  bool moves = false;        // the subject, by 2 mm
  bool may_succeed = false;  // status 0 with a right model is as good
};

const std::vector<Case> cases{
    {"frozen-for-good@5", 4, "cannot be opened: ", 30, 19, 4},
    {"slow", 0, "", 40, 19, -1},
    {"projector-mode@5", 4, "its mode is 800 x 600 at 60 Hz, the calibration needs 256 x 192 at 60 Hz", 20,
     19, 4},
    {"move=2@12", 0, "", 15, 40, 0, true},
    {"late@5", 4, "the same picture as the shot before", 30, 19, -1, false, true},
    {"projector-gone@5", 0, "was unplugged: check its cable and power", 15},
    {"frozen@5", 0, "does not answer: switch it off and on, check the cable", 15},
    {"disconnect@5", 0, "switch it off and on, check the cable", 15},
    {"stale@5", 0, "the same picture as the shot before", 15, 23},
    {"exposure@5", 0, "another exposure than white's and black's", 15, 23},
    {"dial", 4, "camera D5000: the mode dial is not on M: turn it to M\n", 5, 19, 4},
};

void expect_no_model(const Station& station) {
  EXPECT_TRUE(station.files().empty());
}

void check(const Case& wanted) {
  SCOPED_TRACE(wanted.fault);
  Station station(wanted.fault);
  const Reference& model = wanted.moves ? displaced_reference() : reference();
  const ScanEnd end = station.scan();
  EXPECT_LT(end.seconds, wanted.most_seconds);
  const bool succeeded = end.status == 0 && (wanted.status == 0 || wanted.may_succeed);
  if (succeeded) {
    model.expect_as_good(station.model());
    const nlohmann::json report = station.report();
    const std::string told = report.at("refused").dump() + report.at("troubles").dump();
    EXPECT_NE(told.find(wanted.told), std::string::npos) << told;
    if (!wanted.may_succeed) {
      EXPECT_LE(report.at("shots").get<int>(), wanted.most_shots);
    }
    EXPECT_EQ(report.at("shot_again_for_motion").get<int>() > 0, wanted.moves);
  } else {
    EXPECT_EQ(end.status, wanted.status) << end.error;
    EXPECT_NE(end.error.find(wanted.told), std::string::npos) << end.error;
    expect_no_model(station);
  }
  if (wanted.next_status < 0) return;
  const ScanEnd next = station.scan();
  EXPECT_EQ(next.status, wanted.next_status) << next.error;
  if (next.status == 0) {
    model.expect_as_good(station.model());
  } else {
    expect_no_model(station);
  }
}

TEST(ScanFaults, NoneHangsOrMakesAWrongModel) {
  // Scans mostly wait.
  constexpr int at_a_time = 4;
  static_cast<void>(reference());
  static_cast<void>(displaced_reference());
  std::atomic<std::size_t> next{0};
  std::vector<std::thread> workers;
  for (int i = 0; i < at_a_time; ++i)
    workers.emplace_back([&] {
      for (std::size_t index = next++; index < cases.size(); index = next++) check(cases[index]);
    });
  for (std::thread& worker : workers) worker.join();
}

}  // namespace
}  // namespace bodyscan
