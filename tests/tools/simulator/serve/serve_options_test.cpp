#include "tools/simulator/serve/serve_options.hpp"

#include <functional>

#include <gtest/gtest.h>

namespace bodyscan::simulator {
namespace {

std::string problem(const std::function<void(ServeOptions&)>& change) {
  ServeOptions options;
  change(options);
  const Expected<void> checked = options.check();
  if (checked) return "none";
  EXPECT_EQ(checked.error().kind, ErrorKind::usage);
  return checked.error().message;
}

TEST(ServeOptions, OutOfRangeIsAUsageErrorThatNamesTheOption) {
  EXPECT_EQ(problem([](ServeOptions&) {}), "none");
  EXPECT_EQ(problem([](ServeOptions& options) { options.port = 70'000; }), "--port: must lie in 0 to 65535");
  EXPECT_EQ(problem([](ServeOptions& options) { options.latency_ms = -1; }),
            "--latency-ms: must lie in 0 to 10000");
  EXPECT_EQ(problem([](ServeOptions& options) { options.rise_ms = 1e6; }),
            "--rise-ms: must lie in 0 to 10000");
  EXPECT_EQ(problem([](ServeOptions& options) { options.render.rig.projector = {}; }),
            "--projector-size: must lie in 16x16 to 8192x8192");
  EXPECT_EQ(problem([](ServeOptions& options) { options.render.rays = 9; }), "--rays: must lie in 1 to 8");
}

}  // namespace
}  // namespace bodyscan::simulator
