#include "tools/simulator/serve/serve.hpp"

#include "tools/simulator/serve/projector_server.hpp"
#include "tools/simulator/serve/ptpip_server.hpp"
#include "tools/simulator/serve/rendering_darkroom.hpp"

#include <csignal>
#include <cstdio>
#include <utility>

#include <poll.h>
#include <sys/signalfd.h>

namespace bodyscan::simulator {
namespace {

constexpr Size other_mode{800, 600};
constexpr Clock::duration unplugged_for = std::chrono::seconds(2);
constexpr Clock::duration longest_exposure = std::chrono::seconds(30);

// Readable once the program has been told to end.
UniqueFd catch_stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);  // before any thread: they inherit it
  return UniqueFd(signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK));
}

bool told_to_stop(const UniqueFd& signals) {
  pollfd descriptor{signals.get(), POLLIN, 0};
  return poll(&descriptor, 1, 0) > 0;
}

// Renders the photos of a whole scan. False: told to stop.
bool prepare(const ServeOptions& options, const PatternSequence& sequence, const UniqueFd& signals,
             RenderingDarkroom& darkroom) {
  std::vector<double> displacements = Faults(options.faults).displacements();
  displacements.push_back(0);
  for (const double displacement : displacements) {
    for (const Pattern& pattern : sequence.patterns) {
      if (told_to_stop(signals)) return false;
      darkroom.prepare(make_picture(render_pattern(pattern, sequence.projector)), 1, displacement);
    }
  }
  return true;
}

}  // namespace

Expected<void> serve(const ServeOptions& options) {
  if (Expected<void> checked = options.check(); !checked) return checked;
  const UniqueFd signals = catch_stop_signals();
  const Faults faults(options.faults);
  Expected<std::unique_ptr<World>> world = World::make(options.render, faults.displacements());
  if (!world) return tl::unexpected(world.error());
  const Size panel = (*world)->projector_size();
  Expected<PatternSequence> sequence = PatternSequence{panel, {}};
  if (options.prepare) sequence = make_sequence(panel, *options.prepare);
  if (!sequence) return tl::unexpected(sequence.error());

  EventLoop loop;
  loop.watch(signals.get(), POLLIN, [&](short) { loop.stop(); });
  WallLight light(make_picture(GrayImage8(panel, 0)), from_seconds(options.latency_ms / 1000),
                  from_seconds(options.rise_ms / 1000));
  Expected<std::unique_ptr<ProjectorServer>> projector =
      ProjectorServer::open(options.projector, panel, loop, [&](Picture picture, Moment moment) {
        light.show(std::move(picture), moment);
        light.forget_before(moment - 2 * longest_exposure);
      });
  if (!projector) return tl::unexpected(projector.error());
  RenderingDarkroom darkroom(**world, light, loop, [&](int shot, Moment moment) {
    if (faults.at(FaultKind::projector_gone, shot)) (*projector)->unplug(moment + unplugged_for);
    if (faults.at(FaultKind::projector_mode, shot)) (*projector)->change_mode(other_mode);
  });
  Camera camera((*world)->camera_size(), faults, darkroom);
  const Expected<std::unique_ptr<PtpIpServer>> network = PtpIpServer::open(options.port, loop, camera);
  if (!network) return tl::unexpected(network.error());

  if (!prepare(options, *sequence, signals, darkroom)) return {};
  const int port = (*network)->port();
  std::printf("ready ptpip:127.0.0.1:%d:%d %s\n", port, port, options.projector.c_str());
  std::fflush(stdout);
  loop.run();
  return {};
}

}  // namespace bodyscan::simulator
