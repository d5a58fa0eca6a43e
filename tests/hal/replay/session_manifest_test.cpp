#include "hal/replay/session_manifest.hpp"

#include <string>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

constexpr std::string_view good = R"({
  "format": "bodyscan-calibration-session", "version": 1, "technician": {"room": [4, null]},
  "board": {"columns": 9, "rows": 7, "square_mm": 25.5},
  "projector": {"width": 1024, "height": 768},
  "projected_board": {"columns": 8, "rows": 6, "first_corner_px": [212.5, 134], "square_px": 75.25},
  "poses": [
    {"printed": "a.jpg", "projected": "b.jpg", "note": "by the door"},
    {"capture": "pose_1"},
    {"printed": "a.jpg", "projected": "c.jpg"}
  ]
})";

std::string replaced(std::string_view from, std::string_view to) {
  std::string text(good);
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string message(const std::string& text) {
  const auto session = parse_session(text, "session.json");
  return session ? "accepted" : session.error().message;
}

std::string with_poses(int count) {
  std::string poses;
  for (int i = 0; i < count; ++i)
    poses += std::string(i ? "," : "") + R"({"capture": "pose_)" + std::to_string(i) + "\"}";
  return R"({"format": "bodyscan-calibration-session", "version": 1,
    "board": {"columns": 3, "rows": 100, "square_mm": 999.9}, "projector": {"width": 2, "height": 2},
    "poses": [)" +
         poses + "]}";
}

TEST(ParseSession, ReadsEveryKey) {
  const auto session = parse_session(good, "session.json");
  ASSERT_TRUE(session) << session.error().message;
  EXPECT_EQ(session->board.columns, 9);
  EXPECT_EQ(session->board.rows, 7);
  EXPECT_EQ(session->board.square_mm, 25.5);
  EXPECT_EQ(session->projector, (Size{1024, 768}));
  ASSERT_TRUE(session->projected_board);
  EXPECT_EQ(session->projected_board->columns, 8);
  EXPECT_EQ(session->projected_board->rows, 6);
  EXPECT_EQ(session->projected_board->first_corner_px, Eigen::Vector2d(212.5, 134));
  EXPECT_EQ(session->projected_board->square_px, 75.25);
  ASSERT_EQ(session->poses.size(), 3U);
  EXPECT_EQ(session->poses[0].name, "pose 0");
  EXPECT_TRUE(session->poses[0].is_pair());
  EXPECT_EQ(session->poses[0].printed, "a.jpg");
  EXPECT_EQ(session->poses[0].projected, "b.jpg");
  EXPECT_EQ(session->poses[0].capture, std::nullopt);
  EXPECT_EQ(session->poses[1].name, "pose 1");
  EXPECT_FALSE(session->poses[1].is_pair());
  EXPECT_EQ(session->poses[1].capture, "pose_1");
  EXPECT_EQ(session->poses[2].printed, "a.jpg");
}

TEST(ParseSession, CapturesNeedNoProjectedBoard) {
  EXPECT_EQ(message(with_poses(1)), "accepted");
  EXPECT_EQ(message(with_poses(200)), "accepted");
}

TEST(ParseSession, AProjectedBoardMayReachThePicturesLastPixel) {
  EXPECT_EQ(message(replaced("[212.5, 134], \"square_px\": 75.25", "[0, 0], \"square_px\": 146.142857")),
            "accepted");
  EXPECT_EQ(message(replaced("[212.5, 134], \"square_px\": 75.25", "[0, 0], \"square_px\": 146.15")),
            "session.json: projected_board: corners lie outside the projector's picture of 1024 x 768");
}

struct Damage {
  std::string_view from;
  std::string_view to;
  std::string_view message;  // behind "session.json: "
};

constexpr Damage damages[] = {
    // the head
    {"bodyscan-calibration-session", "bodyscan-capture",
     "format: \"bodyscan-capture\" is not bodyscan-calibration-session"},
    {"\"format\"", "\"kind\"", "format: missing"},
    {"\"version\": 1", "\"version\": 2", "version: 2 is not 1"},
    {"\"version\": 1", "\"version\": 1, \"version\": 1", "the key \"version\" occurs twice in one object"},
    {"\"projector\"", "\"beamer\"", "projector: missing"},
    {"768", "1", "projector.height: 1 does not lie in 2 to 32768"},
    // the printed board
    {"\"board\"", "\"card\"", "board: missing"},
    {"{\"columns\": 9, \"rows\": 7, \"square_mm\": 25.5}", "[9, 7]", "board: not an object"},
    {"\"columns\": 9", "\"columns\": 2", "board.columns: 2 does not lie in 3 to 100"},
    {"\"columns\": 9", "\"columns\": 101", "board.columns: 101 does not lie in 3 to 100"},
    {"\"columns\": 9", "\"columns\": 9.5", "board.columns: not an integer"},
    {"\"columns\": 9", "\"columns\": 4294967305", "board.columns: 4294967305 does not lie in 3 to 100"},
    {"\"rows\": 7, ", "", "board.rows: missing"},
    {"\"rows\": 7", "\"rows\": \"7\"", "board.rows: not an integer"},
    {"\"rows\": 7", "\"rows\": -7", "board.rows: -7 does not lie in 3 to 100"},
    {", \"square_mm\": 25.5", "", "board.square_mm: missing"},
    {"25.5", "0", "board.square_mm: must be positive"},
    {"25.5", "-25", "board.square_mm: must be positive"},
    {"25.5", "1000", "board.square_mm: must be 0.1 to 1000"},
    {"25.5", "0.09", "board.square_mm: must be 0.1 to 1000"},
    {"25.5", "\"25 mm\"", "board.square_mm: not a number"},
    // the projected board
    {"\"projected_board\"", "\"beamed_board\"",
     "projected_board: missing, but poses[0] is a pair of pictures"},
    {"{\"columns\": 8,", "{\"columns\": 1,", "projected_board.columns: 1 does not lie in 3 to 100"},
    {"\"rows\": 6, ", "", "projected_board.rows: missing"},
    {"[212.5, 134]", "[212.5]", "projected_board.first_corner_px: not an array of two numbers"},
    {"[212.5, 134]", "[212.5, null]", "projected_board.first_corner_px: not an array of two numbers"},
    {"[212.5, 134]", "{\"x\": 1, \"y\": 2}", "projected_board.first_corner_px: not an array of two numbers"},
    {"\"first_corner_px\": [212.5, 134], ", "", "projected_board.first_corner_px: missing"},
    {"75.25", "0", "projected_board.square_px: must be positive"},
    {"75.25", "1.9", "projected_board.square_px: must be 2 or more"},
    {"75.25", "116", "projected_board: corners lie outside the projector's picture of 1024 x 768"},
    {"75.25", "1e308", "projected_board: corners lie outside the projector's picture of 1024 x 768"},
    {"212.5", "-0.5", "projected_board: corners lie outside the projector's picture of 1024 x 768"},
    {"134", "400", "projected_board: corners lie outside the projector's picture of 1024 x 768"},
    // the poses
    {"\"poses\"", "\"pictures\"", "poses: missing"},
    {"{\"capture\": \"pose_1\"}", "\"pose_1\"", "poses[1]: not an object"},
    {"{\"capture\": \"pose_1\"}", "{\"folder\": \"pose_1\"}",
     "poses[1]: neither a pair of pictures (printed, projected) nor a capture"},
    {"{\"capture\": \"pose_1\"}", "{\"capture\": \"pose_1\", \"projected\": \"b.jpg\"}",
     "poses[1]: both a pair of pictures and a capture"},
    {"\"pose_1\"", "1", "poses[1].capture: not a string"},
    {"\"pose_1\"", "\"..\"", "poses[1].capture: not a plain file name inside the folder"},
    {"\"pose_1\"", "\"poses/1\"", "poses[1].capture: not a plain file name inside the folder"},
    {"\"printed\": \"a.jpg\", ", "", "poses[0].printed: missing"},
    {", \"projected\": \"b.jpg\"", "", "poses[0].projected: missing"},
    {"{\"capture\": \"pose_1\"}", "{\"printed\": \"a.jpg\", \"projected\": \"b.jpg\"}",
     "poses[1]: the same as poses[0]"},
    {"\"a.jpg\"", "\"b.jpg\"", "poses[0].projected: the same file as printed"},
    {"\"a.jpg\"", "\"/etc/passwd\"", "poses[0].printed: not a plain file name inside the folder"},
    {"\"b.jpg\"", "\"\"", "poses[0].projected: not a plain file name inside the folder"},
    {"\"b.jpg\"", "\"b\\u0000.jpg\"", "poses[0].projected: not a plain file name inside the folder"},
    {"\"b.jpg\"", "[]", "poses[0].projected: not a string"},
};

TEST(ParseSession, NamesEveryDamage) {
  for (const Damage& damage : damages)
    EXPECT_EQ(message(replaced(damage.from, damage.to)), "session.json: " + std::string(damage.message))
        << damage.to;
}

TEST(ParseSession, NamesAWrongNumberOfPoses) {
  EXPECT_EQ(message(with_poses(0)), "session.json: poses: there must be 1 to 200, not 0");
  EXPECT_EQ(message(with_poses(201)), "session.json: poses: there must be 1 to 200, not 201");
}

TEST(ParseSession, NamesAWrongShape) {
  EXPECT_EQ(message("[]"), "session.json: not a JSON object");
  EXPECT_EQ(message(replaced("\"poses\": [", "\"poses\": {}, \"p\": [")),
            "session.json: poses: not an array");
}

TEST(ParseSession, ATextThatIsNoJsonSaysWhere) {
  EXPECT_EQ(message("{\"format\": ").substr(0, 58),
            "session.json: parse error at line 1, column 12: syntax err");
  EXPECT_NE(message("{\"version\": 1e999}"), "accepted");
  for (std::size_t length = 0; length < good.size(); ++length)
    ASSERT_NE(message(std::string(good.substr(0, length))), "accepted") << length;
  EXPECT_EQ(message(std::string((1 << 20) + 1, ' ')), "session.json: over the limit of 1048576 bytes");
}

}  // namespace
}  // namespace bodyscan
