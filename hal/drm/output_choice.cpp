#include "hal/drm/output_choice.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace bodyscan {
namespace {

using Candidates = std::vector<ProjectorOutput>;

Candidates those(const Candidates& candidates, const std::function<bool(const ProjectorOutput&)>& fits) {
  Candidates fitting;
  std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(fitting), fits);
  return fitting;
}

bool plugged_in(const ProjectorOutput& output) {
  return !output.edid.empty();
}

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
  return text;
}

std::string describe(const std::vector<DisplayMode>& modes) {
  std::vector<std::string> texts;
  for (const DisplayMode& mode : modes)
    if (std::string text = describe(mode); std::find(texts.begin(), texts.end(), text) == texts.end())
      texts.push_back(std::move(text));
  return texts.empty() ? "no mode" : joined(texts);
}

// "the projector NEC 4a21 1234567 at HDMI-A-2", with what the choice leaves open left out.
std::string wanted(const ProjectorChoice& choice) {
  return (choice.edid.empty() ? "a projector" : "the projector " + choice.edid) +
         (choice.connector.empty() ? "" : " at " + choice.connector);
}

std::string preferred(const ProjectorOutput& output) {
  return output.modes.empty() ? "no mode" : describe(output.modes.front());
}

std::string offers(const Candidates& candidates) {
  std::vector<std::string> texts;
  for (const ProjectorOutput& output : candidates)
    texts.push_back(output.edid + " at " + output.connector + " offers " + describe(output.modes));
  return joined(texts);
}

}  // namespace

std::string describe(const std::vector<ProjectorOutput>& outputs) {
  std::vector<std::string> texts;
  for (const ProjectorOutput& output : outputs)
    texts.push_back(output.connector + ": " + (plugged_in(output) ? output.edid : "nothing"));
  return texts.empty() ? "no connectors" : joined(texts);
}

std::optional<DisplayMode> find_mode(const std::vector<DisplayMode>& offered, const DisplayMode& wanted) {
  std::optional<DisplayMode> best;
  double best_distance_hz = 0.5;
  for (const DisplayMode& mode : offered) {
    const double distance_hz = std::abs(mode.refresh_hz - wanted.refresh_hz);
    if (mode.size != wanted.size || !(distance_hz < best_distance_hz)) continue;
    best = mode;
    best_distance_hz = distance_hz;
  }
  return best;
}

Expected<ProjectorChoice> choose_output(const std::vector<ProjectorOutput>& outputs,
                                        const ProjectorChoice& choice) {
  const std::string there = "; plugged in: " + describe(outputs);
  Candidates left = those(outputs, [&](const ProjectorOutput& output) {
    return choice.connector.empty() || output.connector == choice.connector;
  });
  if (left.empty())
    return device_error("needs " + wanted(choice) + ", but there is no such connector" + there);

  left = those(left, plugged_in);
  if (left.empty()) return device_error("needs " + wanted(choice) + ", but nothing is plugged in" + there);

  left = those(
      left, [&](const ProjectorOutput& output) { return choice.edid.empty() || output.edid == choice.edid; });
  if (left.empty()) return device_error("needs " + wanted(choice) + there);

  const Candidates identified = left;
  left = those(
      left, [&](const ProjectorOutput& output) { return find_mode(output.modes, choice.mode).has_value(); });
  if (left.empty())
    return device_error("needs " + describe(choice.mode) + ", the mode of the calibration; " +
                        offers(identified));
  if (left.size() > 1)
    return device_error("needs " + wanted(choice) + ", and several fit: name the connector" + there);
  const ProjectorOutput& only = left.front();
  return ProjectorChoice{only.connector, only.edid, *find_mode(only.modes, choice.mode)};
}

Expected<void> check_unchanged(const ProjectorOutput& chosen, const ProjectorOutput& now,
                               const DisplayMode& mode) {
  if (!plugged_in(now)) return device_error("was unplugged or switched off");
  if (now.edid != chosen.edid) return device_error(now.edid + " is plugged in instead of " + chosen.edid);
  if (preferred(now) != preferred(chosen))
    return device_error("changed its mode: it asks for " + preferred(now) +
                        ", and was opened when it asked for " + preferred(chosen));
  if (!find_mode(now.modes, mode)) return device_error("no longer offers " + describe(mode));
  return {};
}

}  // namespace bodyscan
