#pragma once

#include "pipeline/base/error.hpp"
#include "tools/simulator/subject.hpp"

#include <string>

namespace bodyscan::simulator {

// The distance at which a built-in subject's origin stands before the camera, mm.
inline constexpr double reference_distance = 1050;

// "staircase, spheres, bumps, head, torso, forearm"
const std::string& builtin_subject_names();

// A subject by its name. `detail` is the longest side of the triangles of curved surfaces in mm (spheres and
// bumps are finer: they follow the analytic surface within 0.001 mm at any detail).
Expected<Subject> make_builtin_subject(const std::string& name, double detail);

Subject make_staircase();
Subject make_spheres();
Subject make_bumps();
Subject make_head(double detail);
Subject make_torso(double detail);
Subject make_forearm(double detail);
// Sheet and plate of one surface, in the sheet's board frame.
Subject make_printed_board(const PrintedSheet& sheet);

}  // namespace bodyscan::simulator
