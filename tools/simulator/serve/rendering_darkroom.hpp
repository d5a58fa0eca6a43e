#pragma once

#include "hal/unique_fd.hpp"
#include "tools/simulator/serve/darkroom.hpp"
#include "tools/simulator/serve/event_loop.hpp"
#include "tools/simulator/serve/wall_light.hpp"
#include "tools/simulator/serve/world.hpp"

#include <compare>
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <thread>

namespace bodyscan::simulator {

// Renders what a world looks like in the projector's light, on a thread of its own that wakes the event loop.
// Photos of one settled picture are kept and delivered at once the next time.
class RenderingDarkroom final : public Darkroom {
 public:
  using ShutterOpened = std::function<void(int shot, Moment moment)>;
  // World, light and loop must outlive the darkroom; all but the world are used by the loop's thread only.
  RenderingDarkroom(World& world, const WallLight& light, EventLoop& loop, ShutterOpened shutter_opened);
  RenderingDarkroom(const RenderingDarkroom&) = delete;
  RenderingDarkroom& operator=(const RenderingDarkroom&) = delete;
  ~RenderingDarkroom() override;

  // Renders now, for later.
  void prepare(const Picture& picture, double gain, double displacement);

  void shutter_opened(int shot, Moment moment) override;
  void develop(const Exposure& exposure) override;
  std::optional<Photo> take_photo() override;
  void develop_preview(const Exposure& exposure) override;
  SharedBytes take_preview() override;

 private:
  struct Key {
    std::uint64_t picture;
    double gain;
    double displacement;
    auto operator<=>(const Key&) const = default;
  };
  struct Job {
    LightMix light;
    double gain = 1;
    double displacement = 0;
    std::uint64_t photo = 0;  // number of the photo; 0: a preview
  };
  void work();
  void render(const Job& job);
  void keep(const Job& job, const Photo& photo);
  void add_job(Job job);

  World* world_;
  const WallLight* light_;
  EventLoop* loop_;
  ShutterOpened shutter_opened_;
  UniqueFd woken_;

  std::mutex mutex_;  // of all below
  std::condition_variable changed_;
  std::deque<Job> jobs_;
  bool ends_ = false;
  std::uint64_t photos_ = 0;  // begun so far
  std::optional<Photo> photo_;
  SharedBytes preview_;
  std::map<Key, Photo> kept_;

  std::thread worker_;
};

}  // namespace bodyscan::simulator
