#pragma once

#include "pipeline/calibration/calibrate.hpp"

#include <functional>
#include <optional>
#include <string>

namespace bodyscan {

// A rig and what it would see of a board, without pictures.
struct SyntheticSession {
  Calibration truth;
  PrintedBoard board{9, 7, 25};
  std::vector<RigidTransform> camera_from_board;
  CalibrationRequest request;
};

enum class PoseKind { gray_code, pair };

struct SessionOptions {
  int poses = 7;
  double camera_noise_px = 0.05;
  double projector_noise_px = 0.03;
  std::optional<double> beam_noise_px;  // of projected corners in the camera; nothing: as the printed ones'
  ProjectedBoard projected{9, 7, {230, 180}, 70};
  double largest_tilt_degrees = 30;
  double distance_spread = 0.15;  // of a metre, both ways
  std::function<PoseKind(int pose)> kind = [](int) { return PoseKind::gray_code; };
  unsigned seed = 1;
};

// The D5000 at half size and a projector with lens shift beside it, both with distortion.
Calibration sample_rig();

SyntheticSession make_session(const SessionOptions& options = {});

// What is seen of a board at a pose; squares `scale` times as large as they should be.
PoseObservation observe(const Calibration& rig, const PrintedBoard& board,
                        const RigidTransform& camera_from_board, const SessionOptions& options, PoseKind kind,
                        unsigned seed, double scale = 1);

double baseline(const Calibration& calibration);

// Focal lengths and baseline, relative.
void expect_near_truth(const CalibrationResult& result, const Calibration& truth, double relative);

// The parameter of that name, which must be there.
const ParameterReport& parameter(const CalibrationReport& report, const std::string& name);

}  // namespace bodyscan
