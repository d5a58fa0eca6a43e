#include "app/scan/shooting.hpp"

#include "hal/clock.hpp"

#include <optional>
#include <utility>

namespace bodyscan {
namespace {

constexpr std::int64_t ms_us = 1000;

// Adds the time until its end to a sum of milliseconds.
class Stopwatch {
 public:
  explicit Stopwatch(double& sum_ms) : sum_ms_(sum_ms) {}
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;
  ~Stopwatch() { sum_ms_ += static_cast<double>(monotonic_us() - begin_us_) * 1e-3; }

 private:
  double& sum_ms_;
  std::int64_t begin_us_ = monotonic_us();
};

}  // namespace

Shooting::Shooting(Camera& camera, LightGuard& light, const Rig& rig, PatternSequence sequence,
                   const Patience& patience)
    : camera_(camera), light_(light), rig_(rig), sequence_(std::move(sequence)), patience_(patience) {
  sequence_.patterns.push_back({.kind = PatternKind::white});
}

Expected<void> Shooting::open() {
  return light_.open().and_then([&] { return open_camera(); });
}

Expected<void> Shooting::open_camera() {
  const Expected<CameraIdentity> identity = camera_.open();
  if (!identity) return tl::unexpected(identity.error());
  identity_ = *identity;
  if (!identity_.problems.empty()) {
    std::string problems;
    for (const std::string& problem : identity_.problems)
      problems += (problems.empty() ? "" : "; ") + problem;
    return device_error("camera " + identity_.model + ": " + problems);
  }
  const Expected<CameraSettings> settings = camera_.configure(rig_.camera.settings);
  if (!settings) return tl::unexpected(settings.error());
  settings_ = *settings;
  return {};
}

Expected<void> Shooting::persist(const std::function<Expected<void>()>& retry) {
  const std::int64_t until = monotonic_us() + patience_.give_up_after_ms * ms_us;
  for (;;) {
    Expected<void> done = retry();
    if (done || monotonic_us() > until) return done;
    Expected<void> waited = light_.wait_until(monotonic_us() + patience_.retry_every_ms * ms_us);
    if (!waited) return waited;
  }
}

Expected<void> Shooting::recover_camera(const Error& trouble) {
  const Stopwatch watch(report_.recovery_ms);
  if (Expected<void> going_on = light_.check(); !going_on) return going_on;
  report_.troubles.push_back(trouble.message);
  if (++failures_ >= rig_.scan.attempts) return tl::unexpected(trouble);
  return persist([&] {
    camera_.close();
    return open_camera();
  });
}

Expected<void> Shooting::recover_projector(const Error& trouble) {
  const Stopwatch watch(report_.recovery_ms);
  if (Expected<void> going_on = light_.check(); !going_on) return going_on;
  report_.troubles.push_back(trouble.message);
  if (++failures_ >= rig_.scan.attempts) return tl::unexpected(trouble);
  return persist([&] { return light_.open(); });
}

Expected<void> Shooting::show(const PlannedShot& shot) {
  const Stopwatch watch(report_.show_ms);
  const Pattern& pattern = sequence_.patterns[static_cast<std::size_t>(shot.pattern)];
  const Expected<std::int64_t> flip = light_.show(render_pattern(pattern, sequence_.projector));
  if (!flip) return tl::unexpected(flip.error());
  flip_us_ = *flip;
  return {};
}

Expected<void> Shooting::expose() {
  {
    const Stopwatch watch(report_.settle_ms);
    const auto settle_us = static_cast<std::int64_t>(rig_.projector.settle_ms * 1000);
    if (Expected<void> waited = light_.wait_until(flip_us_ + settle_us); !waited) return waited;
  }
  double taken_ms = 0;
  Expected<void> exposed;
  {
    const Stopwatch watch(taken_ms);
    exposed = camera_.expose();
  }
  report_.exposure_ms += settings_.exposure_us * 1e-3;
  report_.camera_ms += taken_ms - settings_.exposure_us * 1e-3;
  return exposed;
}

Expected<Photograph> Shooting::fetch() {
  const Stopwatch watch(report_.fetch_ms);
  return camera_.fetch();
}

Expected<void> Shooting::shoot(ShotList& list, LiveDecoder& decoder,
                               const std::function<void(int)>& progress) {
  const Stopwatch watch(report_.total_ms);
  std::optional<PlannedShot> current = list.next();
  bool shown = false;
  while (current) {
    if (!shown) {
      if (const Expected<void> done = show(*current); !done) {
        if (Expected<void> back = recover_projector(done.error()); !back) return back;
        continue;
      }
      shown = true;
    }
    if (current->discard_first) {
      const Expected<Photograph> discarded = expose().and_then([&] { return fetch(); });
      if (!discarded) {
        if (Expected<void> back = recover_camera(discarded.error()); !back) return back;
        shown = false;
        continue;
      }
    }
    std::optional<PlannedShot> next;
    Expected<void> next_shown;
    Expected<Photograph> photograph = expose().and_then([&] {
      // Without a next pattern the same one again: a projector that is gone says so, and this shot is not
      // used.
      next = list.next_without_waiting();
      next_shown = show(next.value_or(*current));
      return fetch();
    });
    if (!photograph || !next_shown) {
      if (next) list.put_back(*next);
      shown = false;
      Expected<void> back =
          photograph ? recover_projector(next_shown.error()) : recover_camera(photograph.error());
      if (!back) return back;
      continue;
    }
    failures_ = 0;
    progress(++report_.shots);
    decoder.hand_over(*current, std::move(*photograph));
    shown = next.has_value();
    if (!next) {
      next = list.next();
      shown = next && next->pattern == current->pattern;
    }
    current = next;
  }
  return list.outcome();
}

}  // namespace bodyscan
