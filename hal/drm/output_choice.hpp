#pragma once

#include "hal/projector.hpp"

#include <optional>
#include <string>
#include <vector>

namespace bodyscan {

// The offered mode that is meant: of that size, and of the refresh rate nearest to the wanted one, within
// half a hertz (a rig file says 60, a display offers 59.94).
std::optional<DisplayMode> find_mode(const std::vector<DisplayMode>& offered, const DisplayMode& wanted);

// The only output that fits, with nothing left open: its connector, its EDID and the mode as it is offered.
// All errors are of kind `device`, and say what is needed and what is there.
Expected<ProjectorChoice> choose_output(const std::vector<ProjectorOutput>& outputs,
                                        const ProjectorChoice& choice);

// Whether what is plugged in is still what it was when it was chosen, and asks for the mode that it asked
// for.
Expected<void> check_unchanged(const ProjectorOutput& chosen, const ProjectorOutput& now,
                               const DisplayMode& mode);

// "HDMI-A-1: NEC 4a21 1234567, HDMI-A-2: nothing"; for messages.
std::string describe(const std::vector<ProjectorOutput>& outputs);

}  // namespace bodyscan
