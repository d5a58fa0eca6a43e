// The plain way to find a board: cv::findChessboardCorners at full size. Exit status 0 found, 1 not found;
// killed by an alarm after SECONDS.
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <unistd.h>

int main(int count, char** arguments) {
  if (count != 5) {
    std::fprintf(stderr, "usage: bodyscan-peer-chessboard PICTURE COLUMNS ROWS SECONDS\n");
    return 2;
  }
  alarm(static_cast<unsigned>(std::atoi(arguments[4])));
  const cv::Mat picture = cv::imread(arguments[1], cv::IMREAD_GRAYSCALE);
  if (picture.empty()) return 2;
  std::vector<cv::Point2f> corners;
  return cv::findChessboardCorners(picture, {std::atoi(arguments[2]), std::atoi(arguments[3])}, corners) ? 0
                                                                                                         : 1;
}
