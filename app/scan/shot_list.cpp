#include "app/scan/shot_list.hpp"

#include <algorithm>
#include <numeric>

namespace bodyscan {
namespace {

std::vector<int> all(int patterns) {
  std::vector<int> indices(static_cast<std::size_t>(patterns));
  std::iota(indices.begin(), indices.end(), 0);
  return indices;
}

}  // namespace

ShotList::ShotList(int patterns, int attempts) : ShotList(all(patterns), patterns, attempts) {}

ShotList::ShotList(const std::vector<int>& wanted, int patterns, int attempts)
    : refused_(static_cast<std::size_t>(patterns), 0), attempts_(attempts) {
  for (const int pattern : wanted) shots_.push_back({pattern, false, 0});
}

std::optional<PlannedShot> ShotList::take() {
  if (failure_ || shots_.empty()) return std::nullopt;
  PlannedShot shot = shots_.front();
  shot.epoch = epoch_;
  shots_.pop_front();
  ++unjudged_;
  return shot;
}

std::optional<PlannedShot> ShotList::next() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return failure_ || !shots_.empty() || unjudged_ == 0; });
  return take();
}

std::optional<PlannedShot> ShotList::next_without_waiting() {
  const std::lock_guard lock(mutex_);
  return take();
}

void ShotList::bring_back(const PlannedShot& shot) {
  const auto place = std::ranges::lower_bound(shots_, shot.pattern, {}, &PlannedShot::pattern);
  if (place == shots_.end() || place->pattern != shot.pattern) shots_.insert(place, shot);
}

void ShotList::put_back(const PlannedShot& shot) {
  const std::lock_guard lock(mutex_);
  --unjudged_;
  // A refusal may have brought back other patterns meanwhile. What is thrown away after it is thrown away
  // before whichever shot is the first.
  const bool discard_first = shot.discard_first || (!shots_.empty() && shots_.front().discard_first);
  bring_back(shot);
  shots_.front().discard_first = discard_first;
  changed_.notify_all();
}

bool ShotList::outdated(const PlannedShot& shot) {
  const std::lock_guard lock(mutex_);
  return shot.epoch < epoch_;
}

void ShotList::accept() {
  const std::lock_guard lock(mutex_);
  --unjudged_;
  changed_.notify_all();
}

void ShotList::refuse(int judged, const std::vector<int>& again, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  --unjudged_;
  ++epoch_;
  refusals_.push_back("pattern " + std::to_string(judged) + ": " + reason);
  if (++refused_.at(static_cast<std::size_t>(judged)) >= attempts_ && !failure_)
    failure_ = Error{ErrorKind::device, "camera: pattern " + std::to_string(judged) + " was shot " +
                                            std::to_string(attempts_) + " times in vain: " + reason};
  for (const int pattern : again) bring_back({pattern, false, 0});
  if (!shots_.empty()) shots_.front().discard_first = true;
  changed_.notify_all();
}

void ShotList::fail(const Error& error) {
  const std::lock_guard lock(mutex_);
  if (!failure_) failure_ = error;
  changed_.notify_all();
}

Expected<void> ShotList::outcome() {
  const std::lock_guard lock(mutex_);
  if (failure_) return tl::unexpected(*failure_);
  return {};
}

std::vector<std::string> ShotList::refusals() {
  const std::lock_guard lock(mutex_);
  return refusals_;
}

}  // namespace bodyscan
