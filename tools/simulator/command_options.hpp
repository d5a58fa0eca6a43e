#pragma once

#include "tools/simulator/render_options.hpp"

#include <functional>
#include <memory>
#include <string>

namespace CLI {
class App;
}

namespace bodyscan::simulator {

// What a command does once its options are known.
using Action = std::function<Expected<void>()>;

// Each command adds itself: its name, options and help to `app`, and, if it is the one named, what it does to
// `action`.
void add_render_command(CLI::App& app, Action& action);
void add_calibration_command(CLI::App& app, Action& action);
void add_rig_command(CLI::App& app, Action& action);
void add_serve_command(CLI::App& app, Action& action);

// Options that several commands have. `options` must outlive the parsing and is set when it is done.
void add_subject_options(CLI::App& command, RenderOptions& options);
// `projector_size`: what the option is called that gives the projector's.
void add_rig_options(CLI::App& command, RigOptions& rig, const std::string& projector_size = "--projector");
void add_light_options(CLI::App& command, RenderOptions& options);
// Camera, noise and the quality of JPEGs.
void add_sensor_options(CLI::App& command, RenderOptions& options);
// The same and the files' format.
void add_camera_options(CLI::App& command, RenderOptions& options);

}  // namespace bodyscan::simulator
