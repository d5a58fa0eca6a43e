#pragma once

#include "hal/projector.hpp"
#include "hal/unique_fd.hpp"

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

namespace bodyscan {

// The projector of a simulated world: a program that listens on a unix socket and shows pictures from shared
// memory (wire.hpp). A flip that is not answered within a second is a lost projector.
class VirtualProjector : public Projector {
 public:
  VirtualProjector(std::filesystem::path socket, ProjectorChoice choice);
  ~VirtualProjector() override;

  Expected<void> open() override;
  [[nodiscard]] DisplayMode mode() const override { return choice_.mode; }
  Expected<std::int64_t> show(const GrayImage8& picture) override;
  void close() override;

  // Who answers at the socket.
  static Expected<ProjectorOutput> identify(const std::filesystem::path& socket);

 private:
  [[nodiscard]] tl::unexpected<Error> lose(const std::string& reason);

  std::filesystem::path path_;
  ProjectorChoice choice_;
  UniqueFd socket_;
  std::span<std::byte> pictures_;  // two, mapped
  std::uint32_t sequence_ = 0;
  bool lost_ = false;
};

}  // namespace bodyscan
