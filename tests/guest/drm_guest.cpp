// What the guest runs: drives a DrmProjector as the lines on its input say, one answer a line.
//   list            what list_outputs gives, as JSON
//   open WIDTH HEIGHT HZ [CONNECTOR [EDID]]
//   show white | black | ramp | gray row|column BIT [inverted]
//                   the time of the flip and the time now (us, CLOCK_MONOTONIC)
//   second          opens a second master
//   descriptors     how many are open
//   close
// Answers are "ok ...", "error: ..." (of kind device) or "mistake: ..."; it greets with the first.
#include "hal/clock.hpp"
#include "hal/drm/drm_master.hpp"
#include "hal/drm/drm_projector.hpp"
#include "pipeline/pattern/sequence.hpp"

#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <memory>
#include <sstream>
#include <string>

#include <nlohmann/json.hpp>

namespace bodyscan {
namespace {

using Answer = Expected<std::string>;

Answer list() {
  const auto outputs = list_outputs();
  if (!outputs) return tl::unexpected(outputs.error());
  nlohmann::json all = nlohmann::json::array();
  for (const ProjectorOutput& output : *outputs) {
    nlohmann::json modes = nlohmann::json::array();
    for (const DisplayMode& mode : output.modes) modes.push_back(describe(mode));
    all.push_back({{"connector", output.connector}, {"edid", output.edid}, {"modes", modes}});
  }
  return all.dump();
}

GrayImage8 picture(std::istream& words, Size size) {
  std::string kind;
  words >> kind;
  if (kind == "ramp") {
    GrayImage8 ramp(size);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) ramp(x, y) = static_cast<std::uint8_t>(x + y);
    return ramp;
  }
  if (kind != "gray")
    return render_pattern({.kind = kind == "white" ? PatternKind::white : PatternKind::black}, size);
  Pattern pattern{.kind = PatternKind::gray};
  std::string axis;
  std::string inverted;
  words >> axis >> pattern.bit >> inverted;
  pattern.axis = axis == "row" ? Axis::row : Axis::column;
  pattern.inverted = inverted == "inverted";
  return render_pattern(pattern, size);
}

ProjectorChoice parse(const std::string& text) {
  std::istringstream words(text);
  ProjectorChoice choice;
  words >> choice.mode.size.width >> choice.mode.size.height >> choice.mode.refresh_hz >> choice.connector;
  std::getline(words >> std::ws, choice.edid);
  return choice;
}

Answer count_descriptors() {
  const std::filesystem::directory_iterator open_files("/proc/self/fd");
  return std::to_string(std::distance(begin(open_files), end(open_files)));
}

class Guest {
 public:
  explicit Guest(std::shared_ptr<DrmMaster> master) : master_(std::move(master)) {}

  Answer obey(const std::string& line) {
    std::istringstream words(line);
    std::string verb;
    words >> verb;
    if (verb == "list") return list();
    if (verb == "open") return open(words);
    if (verb == "show" && projector_) return show(words);
    if (verb == "descriptors") return count_descriptors();
    if (verb == "second") return DrmMaster::open().map([](const auto&) { return std::string(); });
    if (verb == "close" && projector_) return projector_->close(), std::string();
    return tl::unexpected(Error{ErrorKind::usage, "what is '" + line + "'?"});
  }

 private:
  // The same projector again where the choice is the same.
  Answer open(std::istream& words) {
    std::string text;
    std::getline(words >> std::ws, text);
    if (!projector_ || text != choice_) projector_ = std::make_unique<DrmProjector>(master_, parse(text));
    choice_ = text;
    return projector_->open().map([] { return std::string(); });
  }

  Answer show(std::istream& words) {
    const Expected<std::int64_t> flip = projector_->show(picture(words, projector_->mode().size));
    if (!flip) return tl::unexpected(flip.error());
    return std::to_string(*flip) + " " + std::to_string(monotonic_us());
  }

  std::shared_ptr<DrmMaster> master_;
  std::unique_ptr<DrmProjector> projector_;
  std::string choice_;
};

int run() {
  const auto master = DrmMaster::open();
  if (!master) {
    std::cout << "error: " << master.error().message << std::endl;
    return 1;
  }
  Guest guest(*master);
  std::cout << "ok" << std::endl;
  for (std::string line; std::getline(std::cin, line);) {
    const Answer answer = guest.obey(line);
    const bool device = !answer && answer.error().kind == ErrorKind::device;
    std::cout << (answer ? "ok " + *answer : (device ? "error: " : "mistake: ") + answer.error().message)
              << std::endl;
  }
  return 0;
}

}  // namespace
}  // namespace bodyscan

int main() {
  try {
    return bodyscan::run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "drm_guest: %s\n", error.what());
    return 1;
  }
}
