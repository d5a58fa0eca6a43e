#pragma once

#include "pipeline/base/error.hpp"

#include <optional>
#include <string>
#include <vector>

namespace bodyscan::simulator {

enum class FaultKind {
  slow,             // every shot is delivered 1 s late
  frozen,           // from this shot on the camera answers nothing until a new connection is made
  frozen_for_good,  // ... and never again
  disconnect,       // closes the connection in the middle of this shot's exposure
  stale,            // this shot delivers the picture of the shot before
  late,             // from this shot on every shot delivers the picture of the shot before
  exposure,         // this shot gets four times the light
  dial,             // the mode dial stands on P: shutter and aperture cannot be set
  move,             // from this shot on the subject stands displaced along the camera's x
  projector_gone,   // at this shot the projector is unplugged for 2 s
  projector_mode,   // at this shot the projector changes to 800 x 600
};

struct Fault {
  FaultKind kind{};
  int shot = 0;         // counted from 1; 0: of no shot
  double distance = 0;  // mm, of a moved subject
};

// "KIND", "KIND@SHOT" or "move=MM@SHOT"; an error of kind `usage` names --fault.
Expected<Fault> parse_fault(const std::string& text);
// For the command's help.
const char* fault_names();

// What goes wrong at which shot.
class Faults {
 public:
  Faults() = default;
  explicit Faults(std::vector<Fault> faults) : faults_(std::move(faults)) {}

  [[nodiscard]] bool has(FaultKind kind) const;
  [[nodiscard]] bool at(FaultKind kind, int shot) const;
  // At this shot or one before.
  [[nodiscard]] bool since(FaultKind kind, int shot) const;
  // How far the subject stands off its place at a shot, mm along the camera's x.
  [[nodiscard]] double displacement(int shot) const;
  // All displacements there are, the first place apart.
  [[nodiscard]] std::vector<double> displacements() const;

 private:
  std::vector<Fault> faults_;
};

}  // namespace bodyscan::simulator
