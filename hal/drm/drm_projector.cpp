#include "hal/drm/drm_projector.hpp"

#include "hal/drm/output_choice.hpp"

#include <algorithm>
#include <utility>

namespace bodyscan {

DrmProjector::DrmProjector(std::shared_ptr<DrmMaster> master, ProjectorChoice choice)
    : master_(std::move(master)), choice_(std::move(choice)) {}

DrmProjector::~DrmProjector() {
  DrmProjector::close();
}

Expected<void> DrmProjector::open() {
  close();
  const Expected<std::vector<ProjectorOutput>> outputs = master_->probe();
  if (!outputs) return tl::unexpected(outputs.error().within("projector"));
  const Expected<ProjectorChoice> chosen = choose_output(*outputs, choice_);
  if (!chosen) return tl::unexpected(chosen.error().within("projector"));
  output_ = *std::find_if(outputs->begin(), outputs->end(), [&](const ProjectorOutput& output) {
    return output.connector == chosen->connector;
  });
  mode_ = chosen->mode;
  if (Expected<void> lit = master_->light(output_.connector, mode_); !lit) return lose(lit.error());
  state_ = State::open;
  return {};
}

Expected<std::int64_t> DrmProjector::show(const GrayImage8& picture) {
  if (state_ == State::closed) return device_error("projector: is closed, not open");
  if (state_ == State::lost) return device_error(place() + ": was lost and must be opened again");
  if (picture.size() != mode_.size)
    return device_error(place() + ": a picture of another size than its mode");
  if (Expected<void> present = check_present(); !present) return lose(present.error());
  Expected<std::int64_t> shown = master_->show(output_.connector, picture);
  if (shown) return shown;
  const Expected<void> present = check_present();
  return lose(present ? shown.error() : present.error());
}

void DrmProjector::close() {
  if (state_ == State::open) {
    // Where this fails the projector is gone, and so dark.
    const auto black = show(GrayImage8(mode_.size, 0));
    static_cast<void>(black);
  }
  state_ = State::closed;
}

Expected<void> DrmProjector::check_present() const {
  const auto check = [&]() -> Expected<void> {
    const Expected<ProjectorOutput> now = master_->look_at(output_.connector);
    return now.and_then(
        [&](const ProjectorOutput& output) { return check_unchanged(output_, output, mode_); });
  };
  Expected<void> unchanged = check();
  if (!unchanged && master_->probe()) unchanged = check();
  if (unchanged && !master_->is_lit(output_.connector))
    return device_error("no longer gets " + describe(mode_));
  return unchanged;
}

tl::unexpected<Error> DrmProjector::lose(const Error& reason) {
  master_->darken(output_.connector);
  state_ = State::lost;
  return tl::unexpected(reason.within(place()));
}

std::string DrmProjector::place() const {
  return "projector at " + output_.connector;
}

}  // namespace bodyscan
