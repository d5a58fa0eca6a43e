#include "tools/simulator/session_options.hpp"

#include "tools/simulator/session_poses.hpp"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

namespace bodyscan::simulator {
namespace {

constexpr std::array kinds{Blunder::cut,    Blunder::moved, Blunder::blurred,    Blunder::size,
                           Blunder::scaled, Blunder::dark,  Blunder::overexposed};

TEST(SessionOptions, TheDefaultsAreLegal) {
  EXPECT_TRUE(SessionOptions{}.check());
}

TEST(SessionOptions, TheLimitsAreLegal) {
  SessionOptions options;
  options.poses = most_session_poses;
  options.bend_mm = -30;  // of a sheet 300 mm wide
  options.plate_mm = 0;
  options.projected_share = smallest_projected_share;
  options.blunders = {{most_session_poses - 1, Blunder::cut}};
  EXPECT_TRUE(options.check());
}

TEST(SessionOptions, AnErrorNamesItsOption) {
  const std::vector<std::pair<std::string, std::function<void(SessionOptions&)>>> cases{
      {"--poses: must lie in 1 to 14", [](SessionOptions& o) { o.poses = 0; }},
      {"--poses", [](SessionOptions& o) { o.poses = most_session_poses + 1; }},
      {"--columns: must lie in 3 to 50", [](SessionOptions& o) { o.board.columns = 2; }},
      {"--rows: must lie in 3 to 50", [](SessionOptions& o) { o.board.rows = 51; }},
      {"--square-mm", [](SessionOptions& o) { o.board.square_mm = std::nan(""); }},
      {"--bend: must lie in -30 to 30", [](SessionOptions& o) { o.bend_mm = 30.1; }},
      {"--plate", [](SessionOptions& o) { o.plate_mm = -1; }},
      {"--projected-share: must lie in 0.1 to 1", [](SessionOptions& o) { o.projected_share = 0.09; }},
      {"--blunder: there is no pose 7 (0 to 6)",
       [](SessionOptions& o) {
         o.blunders = {{7, Blunder::cut}};
       }},
      {"--blunder: there is no pose -1",
       [](SessionOptions& o) {
         o.blunders = {{-1, Blunder::cut}};
       }},
      {"--lens-blur", [](SessionOptions& o) { o.render.lens_blur = -1; }},
  };
  for (const auto& [wanted, spoil] : cases) {
    SessionOptions options;
    spoil(options);
    const Expected<void> checked = options.check();
    ASSERT_FALSE(checked) << wanted;
    EXPECT_EQ(checked.error().kind, ErrorKind::usage);
    EXPECT_TRUE(checked.error().message.starts_with(wanted)) << checked.error().message;
  }
}

TEST(SessionOptions, MixedSessionsTakeTurnsAndStartProjected) {
  SessionOptions options;
  for (const int pose : {0, 1, 2, 3}) {
    options.method = SessionMethod::mixed;
    EXPECT_EQ(options.is_gray(pose), pose % 2 == 1);
    options.method = SessionMethod::gray;
    EXPECT_TRUE(options.is_gray(pose));
    options.method = SessionMethod::projected;
    EXPECT_FALSE(options.is_gray(pose));
  }
}

TEST(ParseBlunder, ReadsEveryNamedKind) {
  for (const Blunder kind : kinds) {
    ASSERT_FALSE(name_of(kind).empty());
    const Expected<PlantedBlunder> blunder = parse_blunder("12:" + name_of(kind));
    ASSERT_TRUE(blunder) << name_of(kind);
    EXPECT_EQ(blunder->pose, 12);
    EXPECT_EQ(blunder->kind, kind);
  }
}

TEST(ParseBlunder, RefusesOtherTextWithTheKindsThereAre) {
  for (const char* text :
       {"", "cut", "3", "3:", ":cut", "3 cut", "3:cuts", "x:cut", "3.5:cut", "99999999999:cut"}) {
    const Expected<PlantedBlunder> blunder = parse_blunder(text);
    ASSERT_FALSE(blunder) << text;
    EXPECT_EQ(blunder.error().kind, ErrorKind::usage);
    EXPECT_EQ(blunder.error().message,
              "--blunder: \"" + std::string(text) +
                  "\" is no POSE:KIND (kinds: cut, moved, blurred, size, scaled, dark, overexposed)");
  }
}

}  // namespace
}  // namespace bodyscan::simulator
