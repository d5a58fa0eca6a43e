#include "tools/simulator/serve/faults.hpp"

#include "tools/simulator/option_range.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

namespace bodyscan::simulator {
namespace {

struct Form {
  std::string_view name;
  FaultKind kind;
  int first_shot;  // 0: the fault is of no shot
};

// A picture can only be the one before from the second shot on.
constexpr std::array<Form, 11> forms{{{"slow", FaultKind::slow, 0},
                                      {"frozen", FaultKind::frozen, 1},
                                      {"frozen-for-good", FaultKind::frozen_for_good, 1},
                                      {"disconnect", FaultKind::disconnect, 1},
                                      {"stale", FaultKind::stale, 2},
                                      {"late", FaultKind::late, 2},
                                      {"exposure", FaultKind::exposure, 1},
                                      {"dial", FaultKind::dial, 0},
                                      {"move", FaultKind::move, 1},
                                      {"projector-gone", FaultKind::projector_gone, 1},
                                      {"projector-mode", FaultKind::projector_mode, 1}}};

template <class Number>
std::optional<Number> number(std::string_view text) {
  Number value{};
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

const char* fault_names() {
  return "slow, dial, frozen@SHOT, frozen-for-good@SHOT, disconnect@SHOT, stale@SHOT, late@SHOT, "
         "exposure@SHOT, move=MM@SHOT, projector-gone@SHOT, projector-mode@SHOT; shots count from 1";
}

Expected<Fault> parse_fault(const std::string& text) {
  const auto wrong = [&](const std::string& why) { return usage_error("--fault: \"" + text + "\": " + why); };
  std::string_view name = text;
  std::optional<std::string_view> shot;
  if (const std::size_t at = name.find('@'); at != std::string_view::npos) {
    shot = name.substr(at + 1);
    name = name.substr(0, at);
  }
  std::optional<std::string_view> distance;
  if (const std::size_t at = name.find('='); at != std::string_view::npos) {
    distance = name.substr(at + 1);
    name = name.substr(0, at);
  }
  const auto* const form = std::ranges::find(forms, name, &Form::name);
  if (form == forms.end()) return wrong(std::string("no such fault (there are: ") + fault_names() + ")");
  if (shot.has_value() != (form->first_shot > 0))
    return wrong(form->first_shot > 0 ? "needs @SHOT" : "is of no single shot");
  if (distance.has_value() != (form->kind == FaultKind::move))
    return wrong(form->kind == FaultKind::move ? "needs =MM" : "has no distance");

  Fault fault{form->kind, 0, 0};
  if (shot) {
    fault.shot = number<int>(*shot).value_or(0);
    if (fault.shot < form->first_shot)
      return wrong("the shot must be a whole number from " + std::to_string(form->first_shot) + " on");
  }
  if (distance) {
    constexpr double farthest = 1000;
    const std::optional<double> value = number<double>(*distance);
    if (!value || !(std::abs(*value) <= farthest)) return wrong("the distance must lie in -1000 to 1000 mm");
    fault.distance = *value;
  }
  return fault;
}

bool Faults::has(FaultKind kind) const {
  return std::ranges::any_of(faults_, [&](const Fault& fault) { return fault.kind == kind; });
}

bool Faults::at(FaultKind kind, int shot) const {
  return std::ranges::any_of(faults_,
                             [&](const Fault& fault) { return fault.kind == kind && fault.shot == shot; });
}

bool Faults::since(FaultKind kind, int shot) const {
  return std::ranges::any_of(faults_,
                             [&](const Fault& fault) { return fault.kind == kind && fault.shot <= shot; });
}

double Faults::displacement(int shot) const {
  double distance = 0;
  int moved_at = 0;
  for (const Fault& fault : faults_) {
    if (fault.kind != FaultKind::move || fault.shot > shot || fault.shot < moved_at) continue;
    distance = fault.distance;
    moved_at = fault.shot;
  }
  return distance;
}

std::vector<double> Faults::displacements() const {
  std::vector<double> distances;
  for (const Fault& fault : faults_) {
    if (fault.kind == FaultKind::move && fault.distance != 0) distances.push_back(fault.distance);
  }
  return distances;
}

}  // namespace bodyscan::simulator
