#include "pipeline/board/board_shift.hpp"
#include "pipeline/board/find_board.hpp"
#include "tests/pipeline/board/synthetic_board.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace bodyscan {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

const PrintedBoard printed_board{9, 6, 25};
const Vector2d printed_middle_mm(100, 62.5);
const ProjectedBoard eight_by_five{8, 5, {200, 150}, 60};

// How the projected board lies on the printed one's plane.
struct Placing {
  Vector2d middle_mm = printed_middle_mm;
  double square_mm = 20;
  double turn_degrees = 5;
  double keystone = 2e-4;  // per projector px
};

ProjectedLight light(const Placing& placing, const ProjectedBoard& board = eight_by_five) {
  const double turn = placing.turn_degrees * std::numbers::pi / 180;
  const Vector2d middle_px = (board.corner_px(0) + board.corner_px(board.corner_count() - 1)) / 2;
  Matrix3d centred = Matrix3d::Identity();
  centred.topRightCorner<2, 1>() = -placing.middle_mm;
  Matrix3d turned = Matrix3d::Identity();
  turned.topLeftCorner<2, 2>() << std::cos(turn), -std::sin(turn), std::sin(turn), std::cos(turn);
  turned.topLeftCorner<2, 2>() *= board.square_px / placing.square_mm;
  Matrix3d onto_picture = Matrix3d::Identity();
  onto_picture.topRightCorner<2, 1>() = middle_px;
  onto_picture(2, 0) = placing.keystone;
  return {board, onto_picture * turned * centred};
}

struct Pair {
  GrayImage8 printed;
  GrayImage8 projected;
  std::vector<Vector2d> truth;  // of the projected corners
};

Pair pair_of(const BoardView& view, const BoardPicture& how, const ProjectedLight& projector) {
  const Matrix3d seen = picture_from_board(printed_board, view);
  BoardPicture lit = how;
  lit.projected = projector;
  ++lit.seed;
  Photograph white = photograph(printed_board, seen, view.picture, how);
  Photograph with = photograph(printed_board, seen, view.picture, lit);
  return {std::move(white.picture), std::move(with.picture), std::move(with.projected)};
}

Expected<FoundBoard> find(const Pair& pair, const ProjectedBoard& board = eight_by_five) {
  const Luma printed = pair.printed.clone();
  const auto below = find_printed_board(printed, printed_board);
  if (!below) return below;
  return find_projected_board(printed, pair.projected.clone(), *below, board);
}

void expect_reason(const Expected<FoundBoard>& found, const std::string& reason) {
  ASSERT_FALSE(found) << found->corners.found() << " corners found, expected: " << reason;
  EXPECT_EQ(found.error().kind, ErrorKind::input);
  EXPECT_EQ(found.error().message, "projected board: " + reason);
}

void expect_found(const Pair& pair, const std::vector<Vector2d>& truth, double rms) {
  const auto found = find(pair);
  ASSERT_TRUE(found) << found.error().message;
  const CornerErrors errors = compare(found->corners, truth);
  EXPECT_EQ(errors.found, eight_by_five.corner_count());
  EXPECT_LT(errors.rms, rms);
}

const BoardView on_the_board{.picture = {400, 300}, .square_px = 28, .tilt_degrees = 20};
// The board to the left in a wide picture.
const BoardView aside{.picture = {720, 320}, .square_px = 30, .middle_px = {-180, 0}, .tilt_degrees = 20};

struct Case {
  const char* name;
  BoardView view;
  Placing placing;
  BoardPicture how;
  double rms;
};
void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}
class ProjectedOnto : public testing::TestWithParam<Case> {};

TEST_P(ProjectedOnto, EveryCornerIsFound) {
  const auto& [name, view, placing, how, rms] = GetParam();
  const Pair pair = pair_of(view, how, light(placing));
  expect_found(pair, pair.truth, rms);
}

// Where printed edges pass near projected corners, the blur mixes the two.
constexpr double crossed = 0.3;
constexpr double clear = 0.06;

INSTANTIATE_TEST_SUITE_P(
    ThePlane, ProjectedOnto,
    testing::Values(
        Case{"smaller_squares", on_the_board, {.square_mm = 16}, {}, crossed},
        Case{"larger_squares", on_the_board, {.square_mm = 29}, {}, crossed},
        Case{"turned", on_the_board, {.turn_degrees = 30}, {}, crossed},
        Case{
            "the_printed_grid", on_the_board, {.square_mm = 25, .turn_degrees = 0, .keystone = 0}, {}, clear},
        Case{"unevenly_lit", on_the_board, {}, {.uneven = 0.8}, crossed},
        Case{"noisy", on_the_board, {}, {.noise = 0.004}, 0.4},
        Case{"beside", aside, {.middle_mm = {320, 62}, .turn_degrees = 10}, {.background = 0.5}, clear},
        Case{"beside_on_a_dark_wall", aside, {.middle_mm = {320, 62}}, {.background = 0.05}, clear},
        Case{"leaving_the_sheet", aside, {.middle_mm = {160, 62}}, {.background = 0.2}, crossed},
        Case{"leaving_the_sheet_for_a_dark_wall",
             aside,
             {.middle_mm = {200, 80}},
             {.background = 0.02},
             crossed}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST(ProjectedBoard, LeavesMostOfItsCornersExact) {
  const Pair pair = pair_of(on_the_board, {}, light({}));
  const auto found = find(pair);
  ASSERT_TRUE(found) << found.error().message;
  std::vector<double> errors;
  for (std::size_t i = 0; i < pair.truth.size(); ++i)
    errors.push_back((*found->corners.corners[i] - pair.truth[i]).norm());
  std::ranges::sort(errors);
  EXPECT_LT(errors[errors.size() / 2], 0.1);
}

// The wall is black until the projector lights it: no ratio to be had there.
TEST(ProjectedBoard, OnAWallThatWasBlackBefore) {
  const Matrix3d seen = picture_from_board(printed_board, aside);
  BoardPicture how{.background = 0};
  Photograph white = photograph(printed_board, seen, aside.picture, how);
  how.background = 0.5;
  how.projected = light({.middle_mm = {330, 62}, .turn_degrees = 10});
  Photograph lit = photograph(printed_board, seen, aside.picture, how);
  const Pair pair{std::move(white.picture), std::move(lit.picture), std::move(lit.projected)};
  expect_found(pair, pair.truth, clear);
}

TEST(ProjectedBoard, UpsideDownItIsCountedFromItsOtherEnd) {
  for (const double turn : {40, 50, 180, -130, -140}) {
    const Pair pair =
        pair_of(on_the_board, {}, light({.square_mm = 18, .turn_degrees = turn, .keystone = 0}));
    // Projector pixels turn against the board: its columns lie at -turn in the picture.
    const bool counted_back = -turn < -45 || -turn > 135;
    expect_found(pair, counted_back ? half_a_turn(pair.truth) : pair.truth, 0.4);
  }
}

TEST(ProjectedBoard, SoItIsWhenTheCameraIs) {
  BoardView rolled = on_the_board;
  rolled.roll_degrees = 180;
  const Pair pair = pair_of(rolled, {}, light({.turn_degrees = 0}));
  expect_found(pair, half_a_turn(pair.truth), crossed);
}

TEST(ProjectedBoard, DoesNotMoveThePrintedOne) {
  const Pair pair = pair_of(on_the_board, {}, light({}));
  const auto below = find_printed_board(pair.printed.clone(), printed_board);
  ASSERT_TRUE(below) << below.error().message;
  EXPECT_LT(board_shift_px(pair.projected.clone(), below->corners).value_or(9), 0.5);
}

TEST(ProjectedBoardMissing, TooDark) {
  const Matrix3d seen = picture_from_board(printed_board, on_the_board);
  for (const double exposure : {0.05, 0.002}) {
    Photograph white = photograph(printed_board, seen, on_the_board.picture, {});
    Photograph lit = photograph(printed_board, seen, on_the_board.picture,
                                {.projected = light({}), .exposure = exposure, .noise = 0.002});
    expect_reason(find(Pair{std::move(white.picture), std::move(lit.picture), {}}),
                  "no chessboard to be seen (too dark)");
  }
}

TEST(ProjectedBoardMissing, OverExposed) {
  const Matrix3d seen = picture_from_board(printed_board, on_the_board);
  Photograph white = photograph(printed_board, seen, on_the_board.picture, {});
  Photograph lit =
      photograph(printed_board, seen, on_the_board.picture, {.projected = light({}), .exposure = 4});
  const auto found = find(Pair{std::move(white.picture), std::move(lit.picture), {}});
  ASSERT_FALSE(found);
  EXPECT_NE(found.error().message.find("over-exposed"), std::string::npos) << found.error().message;
}

TEST(ProjectedBoardMissing, TooFaintAgainstTheRoom) {
  ProjectedLight faint = light({});
  faint.dark = 0.95;
  expect_reason(find(pair_of(on_the_board, {.noise = 0.005}, faint)), "no chessboard to be seen");
}

TEST(ProjectedBoardMissing, NotInThePicture) {
  expect_reason(find(pair_of(on_the_board, {}, light({.middle_mm = {900, 62}}))), "no chessboard to be seen");
}

TEST(ProjectedBoardMissing, PartlyOutsideThePictureOrOnWhatShowsNoLight) {
  for (const Pair& pair : {pair_of(on_the_board, {}, light({.middle_mm = {250, 62}, .square_mm = 26})),
                           pair_of(aside, {.background = 0}, light({.middle_mm = {220, 62}}))}) {
    const auto found = find(pair);
    ASSERT_FALSE(found) << found->corners.found();
    EXPECT_NE(found.error().message.find("of 40 corners found: cut off, covered or blurred"),
              std::string::npos)
        << found.error().message;
  }
}

TEST(ProjectedBoardMissing, OfAnotherSize) {
  expect_reason(find(pair_of(on_the_board, {}, light({})), {7, 5, {200, 150}, 60}),
                "the board seen has 8 x 5 inner corners, not 7 x 5");
}

// With as many corners, it is not to be taken for the projected one.
TEST(ProjectedBoardMissing, ThePrintedOneIsNot) {
  const ProjectedBoard alike{9, 6, {200, 150}, 60};
  ProjectedLight off = light({}, alike);
  off.dark = 1;
  for (const double noise : {0.0, 0.004})
    expect_reason(find(pair_of(on_the_board, {.noise = noise}, off), alike), "no chessboard to be seen");
}

TEST(ProjectedBoard, WithAsManyCornersAsThePrintedOne) {
  const ProjectedBoard alike{9, 6, {200, 150}, 60};
  const Pair pair = pair_of(on_the_board, {}, light({.square_mm = 18}, alike));
  const auto found = find(pair, alike);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(compare(found->corners, pair.truth).found, 54);
  EXPECT_LT(compare(found->corners, pair.truth).rms, crossed);
}

}  // namespace
}  // namespace bodyscan
