#include "pipeline/board/board_shift.hpp"
#include "pipeline/board/find_board.hpp"
#include "tests/pipeline/board/synthetic_board.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

using Eigen::Vector2d;

const PrintedBoard nine_by_six{9, 6, 25};

Photograph shot(const BoardView& view, const BoardPicture& how = {},
                const PrintedBoard& board = nine_by_six) {
  return photograph(board, picture_from_board(board, view), view.picture, how);
}

Expected<FoundBoard> find(Photograph photo, const PrintedBoard& board = nine_by_six) {
  return find_printed_board(std::move(photo.picture), board);
}

void expect_reason(const Expected<FoundBoard>& found, const std::string& reason) {
  ASSERT_FALSE(found) << found->corners.found() << " corners found, expected: " << reason;
  EXPECT_EQ(found.error().kind, ErrorKind::input);
  EXPECT_EQ(found.error().message, "printed board: " + reason);
}

void paint(GrayImage8& picture, int left, int top, int right, int bottom, std::uint8_t grey) {
  for (int y = std::max(0, top); y < std::min(picture.height(), bottom); ++y)
    for (int x = std::max(0, left); x < std::min(picture.width(), right); ++x) picture(x, y) = grey;
}

struct Held {
  const char* name;
  BoardView view;
};
void PrintTo(const Held& held, std::ostream* out) {
  *out << held.name;
}
class BoardHeld : public testing::TestWithParam<Held> {};

TEST_P(BoardHeld, EveryCornerIsFoundToAFractionOfAPixel) {
  Photograph photo = shot(GetParam().view);
  const std::vector<Vector2d> truth = photo.printed;
  const auto found = find(std::move(photo));
  ASSERT_TRUE(found) << found.error().message;
  const CornerErrors errors = compare(found->corners, truth);
  EXPECT_EQ(errors.found, 54);
  EXPECT_LT(errors.rms, 0.05);
  EXPECT_LT(errors.worst, 0.12);
}

INSTANTIATE_TEST_SUITE_P(
    Ways, BoardHeld,
    testing::Values(Held{"frontal", {}},  //
                    Held{"between_pixels", {.middle_px = {3.3, -2.2}}},
                    Held{"in_a_corner_of_the_picture", {.middle_px = {-70, 60}}},
                    Held{"tilted_sideways", {.tilt_degrees = 40}},
                    Held{"tilted_backwards", {.tilt_degrees = 40, .tilt_axis_degrees = 0}},
                    Held{"tilted_about_a_diagonal", {.tilt_degrees = 40, .tilt_axis_degrees = 45}},
                    Held{"tilted_steeply", {.tilt_degrees = 55}}, Held{"rolled", {.roll_degrees = 35}},
                    Held{"rolled_back", {.roll_degrees = -40}},
                    Held{"rolled_and_tilted", {.roll_degrees = 20, .tilt_degrees = 30}},
                    Held{"far_away", {.square_px = 14, .roll_degrees = 7}},
                    Held{"in_a_picture_searched_at_half_size",
                         {.picture = {1400, 500}, .square_px = 22, .roll_degrees = 12, .focal_px = 1400}}),
    [](const auto& instance) { return std::string(instance.param.name); });

// Columns count towards the picture's lower right, so a board that is turned by -45 to 135 degrees is counted
// as it is, any other from its other end.
TEST(BoardDetection, TheFirstCornerIsTheOneThatTheConventionSays) {
  for (const double roll : {0, 60, 90, 130, 140, 180, -40, -50, -90, -150}) {
    Photograph photo = shot({.square_px = 28, .roll_degrees = roll});
    const bool counted_back = roll < -45 || roll > 135;
    const std::vector<Vector2d> truth = counted_back ? half_a_turn(photo.printed) : photo.printed;
    const auto found = find(std::move(photo));
    ASSERT_TRUE(found) << roll << ": " << found.error().message;
    EXPECT_LT(compare(found->corners, truth).worst, 0.2) << roll;
  }
}

TEST(BoardDetection, ABoardWithMoreRowsThanColumns) {
  const PrintedBoard tall{6, 9, 25};
  for (const double roll : {0, 100, 150}) {
    Photograph photo = shot({.square_px = 26, .roll_degrees = roll}, {}, tall);
    const std::vector<Vector2d> truth = roll > 135 ? half_a_turn(photo.printed) : photo.printed;
    const auto found = find(std::move(photo), tall);
    ASSERT_TRUE(found) << roll << ": " << found.error().message;
    EXPECT_LT(compare(found->corners, truth).worst, 0.2) << roll;
  }
}

// Counted as if it were none: the printed board cannot tell, the projector's stripes do.
TEST(BoardDetection, AMirroredBoardIsStillCountedClockwise) {
  const auto found = find(shot({.roll_degrees = 10}, {.mirrored = true}));
  ASSERT_TRUE(found) << found.error().message;
  const Vector2d along = *found->corners.at(8, 0) - *found->corners.at(0, 0);
  const Vector2d down = *found->corners.at(0, 5) - *found->corners.at(0, 0);
  EXPECT_GT(along.x() * down.y() - along.y() * down.x(), 0);
  EXPECT_GT(along.x(), 0);
}

TEST(BoardDetection, SixteenBitsGiveTheSameCorners) {
  const Photograph photo = shot({.roll_degrees = 10, .tilt_degrees = 20});
  GrayImage16 deep(photo.picture.size());
  for (std::size_t i = 0; i < deep.size().area(); ++i)
    deep.data()[i] = static_cast<std::uint16_t>(257 * photo.picture.data()[i]);
  const auto found = find_printed_board(std::move(deep), nine_by_six);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_LT(compare(found->corners, photo.printed).worst, 0.12);
}

TEST(BoardDetection, TheOtherBoardInThePictureIsPassedOver) {
  const PrintedBoard larger{11, 9, 25};
  const Photograph left = shot({.picture = {300, 300}, .square_px = 22}, {}, larger);
  const Photograph right = shot({.picture = {300, 300}, .square_px = 22, .roll_degrees = 8});
  GrayImage8 both({600, 300});
  for (int y = 0; y < 300; ++y) {
    std::copy_n(left.picture.row(y), 300, both.row(y));
    std::copy_n(right.picture.row(y), 300, both.row(y) + 300);
  }
  const auto found = find_printed_board(std::move(both), nine_by_six);
  ASSERT_TRUE(found) << found.error().message;
  std::vector<Vector2d> truth = right.printed;
  for (Vector2d& corner : truth) corner.x() += 300;
  EXPECT_LT(compare(found->corners, truth).worst, 0.12);
}

TEST(BoardCutOff, TheBoardThatIsLeftIsNamed) {
  expect_reason(find(shot({.middle_px = {120, 0}})),
                "the board seen has 8 x 6 inner corners, not 9 x 6: another board, or it is cut off");
  expect_reason(find(shot({.middle_px = {0, 120}})),
                "the board seen has 9 x 5 inner corners, not 9 x 6: another board, or it is cut off");
  expect_reason(find(shot({.middle_px = {-200, 0}})),
                "only 36 of 54 corners found: cut off, covered or blurred");
  expect_reason(find(shot({.middle_px = {500, 0}})), "no chessboard to be seen");
}

TEST(BoardCovered, AThumbCostsTheCornersUnderIt) {
  Photograph photo = shot({.roll_degrees = 5});
  const std::vector<Vector2d> truth = photo.printed;
  const int x = static_cast<int>(truth[0].x());
  const int y = static_cast<int>(truth[0].y());
  paint(photo.picture, x - 40, y - 40, x + 40, y + 10, 90);  // corners 0 and 1
  const auto found = find(std::move(photo));
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_FALSE(found->corners.corners[0]);
  EXPECT_FALSE(found->corners.corners[1]);
  const CornerErrors errors = compare(found->corners, truth);
  EXPECT_EQ(errors.found, 52);
  EXPECT_LT(errors.worst, 0.12);
}

TEST(BoardCovered, AHandHidesTooMuch) {
  Photograph photo = shot({});
  paint(photo.picture, 260, 180, 480, 360, 90);  // a quarter of the board
  expect_reason(find(std::move(photo)), "only 42 of 54 corners found: cut off, covered or blurred");
}

TEST(BoardLight, OverExposed) {
  expect_reason(find(shot({}, {.exposure = 2})), "over-exposed, 50 % of it is pure white");
  expect_reason(find(shot({}, {.exposure = 30})), "no chessboard to be seen (over-exposed)");
}

TEST(BoardLight, AsBrightAsItGetsWithoutClipping) {
  Photograph photo = shot({.roll_degrees = 10}, {.exposure = 1.4});
  const std::vector<Vector2d> truth = photo.printed;
  const auto found = find(std::move(photo));
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_LT(compare(found->corners, truth).worst, 0.12);
}

TEST(BoardLight, TooDark) {
  expect_reason(find(shot({}, {.exposure = 0.003})), "no chessboard to be seen (too dark)");
  expect_reason(find(shot({}, {.exposure = 0.003, .noise = 0.001})), "no chessboard to be seen (too dark)");
  expect_reason(find(shot({}, {.exposure = 0})), "no chessboard to be seen (too dark)");
}

TEST(BoardLight, Uneven) {
  Photograph photo = shot({.roll_degrees = 10}, {.uneven = 0.95});
  const std::vector<Vector2d> truth = photo.printed;
  const auto found = find(std::move(photo));
  ASSERT_TRUE(found) << found.error().message;
  const CornerErrors errors = compare(found->corners, truth);
  EXPECT_EQ(errors.found, 54);
  EXPECT_LT(errors.rms, 0.05);
}

TEST(BoardLight, NoiseIsAveragedOverTheCornersSurroundings) {
  for (const auto& [noise, rms] : {std::pair(0.01, 0.06), std::pair(0.03, 0.2)}) {
    Photograph photo = shot({.roll_degrees = 10}, {.noise = noise});
    const std::vector<Vector2d> truth = photo.printed;
    const auto found = find(std::move(photo));
    ASSERT_TRUE(found) << noise << ": " << found.error().message;
    const CornerErrors errors = compare(found->corners, truth);
    EXPECT_EQ(errors.found, 54);
    EXPECT_LT(errors.rms, rms) << noise;
  }
}

TEST(BoardBlur, IsMeasured) {
  double before = 0;
  for (const double blur : {0.5, 1.0, 2.0}) {
    Photograph photo = shot({.picture = {520, 400}, .square_px = 42, .roll_degrees = 10}, {.blur_px = blur});
    const std::vector<Vector2d> truth = photo.printed;
    const auto found = find(std::move(photo));
    ASSERT_TRUE(found) << blur << ": " << found.error().message;
    EXPECT_LT(compare(found->corners, truth).rms, 0.1) << blur;
    EXPECT_NEAR(found->edge_blur_px, blur, 0.5);  // sharp edges measure softer than they are
    EXPECT_GT(found->edge_blur_px, before + 0.3);
    before = found->edge_blur_px;
  }
}

TEST(BoardBlur, TooMuch) {
  expect_reason(find(shot({}, {.blur_px = 5})),
                "only 0 of 54 corners hold at full size: blurred or too dark");
  expect_reason(find(shot({}, {.blur_px = 20})), "no chessboard to be seen");
}

TEST(NoBoard, IsSeenInAnEmptyPicture) {
  const BoardView out_of_sight{.middle_px = {5000, 0}};
  expect_reason(find(shot(out_of_sight)), "no chessboard to be seen");
  expect_reason(find(shot(out_of_sight, {.noise = 0.02})), "no chessboard to be seen");
}

// A picture smaller than any corner's surroundings, and one of a pixel.
TEST(NoBoard, IsSeenInATinyPicture) {
  for (const Size size : {Size{12, 9}, Size{1, 1}, Size{1, 400}, Size{3, 5300}})
    expect_reason(find_printed_board(GrayImage8(size, 128), nine_by_six), "no chessboard to be seen");
}

struct Wrong {
  PrintedBoard asked;
  const char* reason;
};

TEST(WrongBoard, IsNamedBesideTheOneAskedFor) {
  const Photograph photo = shot({});
  for (const auto& [asked, reason] :
       {Wrong{{8, 6, 25}, "the board seen has 9 x 6 inner corners, not 8 x 6"},
        Wrong{{9, 5, 25}, "the board seen has 9 x 6 inner corners, not 9 x 5"},
        Wrong{{5, 4, 25}, "the board seen has 9 x 6 inner corners, not 5 x 4"},
        Wrong{{9, 7, 25},
              "the board seen has 9 x 6 inner corners, not 9 x 7: another board, or it is cut off"},
        Wrong{{12, 9, 25}, "only 54 of 108 corners found: cut off, covered or blurred"}})
    expect_reason(find_printed_board(photo.picture.clone(), asked), reason);
}

TEST(WrongBoard, IsNamedTooWhereSomeOfItsCornersAreCovered) {
  Photograph photo = shot({});
  const Vector2d middle = photo.printed[22];
  paint(photo.picture, static_cast<int>(middle.x()) - 12, static_cast<int>(middle.y()) - 12,
        static_cast<int>(middle.x()) + 12, static_cast<int>(middle.y()) + 12, 90);
  expect_reason(find_printed_board(photo.picture.clone(), {6, 5, 25}),
                "the board seen has at least 9 x 6 inner corners, not 6 x 5");
}

TEST(BoardShift, IsHowFarTheBoardMoved) {
  const BoardView before{.roll_degrees = 5};
  Photograph photo = shot(before);
  const auto found = find(std::move(photo));
  ASSERT_TRUE(found) << found.error().message;
  for (const double moved : {0.0, 0.5, 2.0}) {
    const Photograph later =
        shot({.middle_px = moved * Vector2d(0.6, 0.8), .roll_degrees = 5}, {.noise = 0.003, .seed = 2});
    EXPECT_NEAR(board_shift_px(later.picture.clone(), found->corners).value_or(-1), moved, 0.08) << moved;
  }
  Photograph hidden = shot({.middle_px = {2, 0}, .roll_degrees = 5});
  paint(hidden.picture, 0, 0, 480, 242, 90);
  EXPECT_FALSE(board_shift_px(std::move(hidden.picture), found->corners)) << "all but its lowest row";
  const Photograph gone = shot({.middle_px = {5000, 0}});
  EXPECT_FALSE(board_shift_px(gone.picture.clone(), found->corners));
}

// Squares are 32 px: the corners are not where they were, but together they tell.
TEST(BoardShift, IsKnownUpToHalfASquare) {
  const auto found = find(shot({.roll_degrees = 5}));
  ASSERT_TRUE(found) << found.error().message;
  for (const double moved : {5.0, 9.0, 14.0}) {
    const Photograph later =
        shot({.middle_px = moved * Vector2d(0.6, 0.8), .roll_degrees = 6}, {.noise = 0.003, .seed = 2});
    const auto shift = board_shift_px(later.picture.clone(), found->corners);
    ASSERT_TRUE(shift) << moved;
    EXPECT_NEAR(*shift, moved, 1.5);
  }
}

}  // namespace
}  // namespace bodyscan
