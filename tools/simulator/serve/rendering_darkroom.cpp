#include "tools/simulator/serve/rendering_darkroom.hpp"

#include <utility>

#include <poll.h>
#include <sys/eventfd.h>

namespace bodyscan::simulator {
namespace {

constexpr std::size_t most_kept = 128;

}  // namespace

RenderingDarkroom::RenderingDarkroom(World& world, const WallLight& light, EventLoop& loop,
                                     ShutterOpened shutter_opened)
    : world_(&world),
      light_(&light),
      loop_(&loop),
      shutter_opened_(std::move(shutter_opened)),
      woken_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      worker_([this] { work(); }) {
  // What has been developed is asked for by the camera, whose timer the loop calls after every wait.
  loop.watch(woken_.get(), POLLIN, [this](short) {
    eventfd_t count = 0;
    eventfd_read(woken_.get(), &count);
  });
}

RenderingDarkroom::~RenderingDarkroom() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  worker_.join();
  loop_->unwatch(woken_.get());
}

void RenderingDarkroom::prepare(const Picture& picture, double gain, double displacement) {
  const Job job{{{picture, 1}}, gain, displacement, 0};
  const Photo photo = world_->photograph(job.light, gain, displacement);
  const std::lock_guard lock(mutex_);
  keep(job, photo);
}

void RenderingDarkroom::shutter_opened(int shot, Moment moment) {
  shutter_opened_(shot, moment);
}

void RenderingDarkroom::develop(const Exposure& exposure) {
  LightMix light = light_->mean(exposure.begin, exposure.end);
  const Key key{light.front().picture->key, exposure.gain, exposure.displacement};
  const bool settled = light.size() == 1;
  std::uint64_t number = 0;
  {
    const std::lock_guard lock(mutex_);
    number = ++photos_;
    photo_.reset();
    const auto found = kept_.find(key);
    if (settled && found != kept_.end()) {
      photo_ = found->second;
      return;
    }
  }
  add_job({std::move(light), exposure.gain, exposure.displacement, number});
}

std::optional<Photo> RenderingDarkroom::take_photo() {
  const std::lock_guard lock(mutex_);
  return std::exchange(photo_, std::nullopt);
}

void RenderingDarkroom::develop_preview(const Exposure& exposure) {
  LightMix light = light_->mean(exposure.begin, exposure.end);
  {
    const std::lock_guard lock(mutex_);
    preview_ = nullptr;
  }
  add_job({std::move(light), exposure.gain, exposure.displacement, 0});
}

SharedBytes RenderingDarkroom::take_preview() {
  const std::lock_guard lock(mutex_);
  return std::exchange(preview_, nullptr);
}

void RenderingDarkroom::add_job(Job job) {
  {
    const std::lock_guard lock(mutex_);
    jobs_.push_back(std::move(job));
  }
  changed_.notify_all();
}

void RenderingDarkroom::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return ends_ || !jobs_.empty(); });
    if (ends_) return;
    const Job job = std::move(jobs_.front());
    jobs_.pop_front();
    if (job.photo != 0 && job.photo != photos_) continue;  // given up
    lock.unlock();
    render(job);
    lock.lock();
  }
}

void RenderingDarkroom::render(const Job& job) {
  if (job.photo == 0) {
    SharedBytes preview = world_->preview(job.light, job.gain, job.displacement);
    const std::lock_guard lock(mutex_);
    preview_ = std::move(preview);
  } else {
    const Photo photo = world_->photograph(job.light, job.gain, job.displacement);
    const std::lock_guard lock(mutex_);
    if (job.photo == photos_) photo_ = photo;
    keep(job, photo);
  }
  eventfd_write(woken_.get(), 1);
}

void RenderingDarkroom::keep(const Job& job, const Photo& photo) {
  if (job.light.size() != 1 || kept_.size() >= most_kept) return;
  kept_.emplace(Key{job.light.front().picture->key, job.gain, job.displacement}, photo);
}

}  // namespace bodyscan::simulator
