#pragma once

#include "hal/virtual_projector/wire.hpp"
#include "pipeline/base/error.hpp"
#include "tools/simulator/serve/event_loop.hpp"
#include "tools/simulator/serve/shared_pictures.hpp"
#include "tools/simulator/serve/wall_light.hpp"

#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

namespace bodyscan::simulator {

// A virtual projector (hal/virtual_projector/wire.hpp) of 60 Hz. A flip is done at the next frame boundary,
// one a frame. Without a client it is dark.
class ProjectorServer {
 public:
  // Called with every picture and the moment from which the projector has it. A mode other than the panel's
  // is stretched to the panel.
  using Show = std::function<void(Picture picture, Moment moment)>;

  // `loop` must outlive the server.
  static Expected<std::unique_ptr<ProjectorServer>> open(std::filesystem::path path, Size panel,
                                                         EventLoop& loop, Show show);
  ProjectorServer(const ProjectorServer&) = delete;
  ProjectorServer& operator=(const ProjectorServer&) = delete;
  ~ProjectorServer();

  // Drops the client; connections are refused until `until`.
  void unplug(Moment until);
  // Drops the client; the next one is greeted with this mode.
  void change_mode(Size mode);

 private:
  struct Client {
    UniqueFd fd;
    SharedPictures pictures;
  };
  struct PendingFlip {
    Picture picture;
    std::uint32_t sequence = 0;
  };

  ProjectorServer(std::filesystem::path path, Size panel, EventLoop& loop, Show show);
  Expected<void> listen();
  void stop_listening();
  void accept_client();
  void drop_client();
  void receive();
  [[nodiscard]] std::optional<Moment> next_due() const;
  void advance(Moment now);
  // The first frame boundary after `moment`.
  [[nodiscard]] Moment boundary_after(Moment moment) const;

  std::filesystem::path path_;
  Size panel_;
  Size mode_;
  EventLoop* loop_;
  Show show_;
  Moment first_frame_;
  UniqueFd listener_;
  std::optional<Moment> plugged_in_at_;  // while unplugged
  std::optional<Client> client_;
  std::deque<PendingFlip> flips_;
  Moment next_frame_;  // when the first of them is done
};

}  // namespace bodyscan::simulator
