#pragma once

#include "hal/unique_fd.hpp"
#include "hal/virtual_projector/wire.hpp"
#include "pipeline/base/image.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace bodyscan {

// What the other side of a virtual projector's socket does with one client.
using Behaviour = std::function<void(int client)>;

// A program that listens on a unix socket; its clients come one after the other, each to the next behaviour
// and all further ones to the last.
class FakeServer {
 public:
  FakeServer(const std::filesystem::path& socket, std::vector<Behaviour> behaviours);
  FakeServer(const FakeServer&) = delete;
  FakeServer& operator=(const FakeServer&) = delete;
  // Every client must be gone.
  ~FakeServer();

 private:
  void serve();

  UniqueFd listener_;
  std::vector<Behaviour> behaviours_;
  std::thread thread_;
};

// A projector as wire.hpp has it, without light.
class FakeProjector {
 public:
  struct Shown {
    std::uint32_t buffer = 0;
    std::vector<std::uint8_t> picture;
    std::int64_t time_us = 0;  // as it was told to the client
  };

  // `bytes` of memory; none: two pictures'.
  explicit FakeProjector(const virtual_projector::Hello& hello, std::optional<std::size_t> bytes = {});

  // Greets and shows until the client goes, or until `flips` pictures are shown.
  void serve(int client, int flips = -1);
  void greet(int client) const;
  // The next Flip; nothing once the client is gone.
  static std::optional<virtual_projector::Flip> next(int client);

  // What was shown until now, which is then forgotten.
  std::vector<Shown> shown();
  [[nodiscard]] int memory() const { return memory_.get(); }

 private:
  virtual_projector::Hello hello_;
  UniqueFd memory_;
  std::mutex mutex_;
  std::vector<Shown> shown_;
};

// A message and the descriptors that travel with it.
void send_with(int client, const void* message, std::size_t bytes, const std::vector<int>& descriptors);

}  // namespace bodyscan
