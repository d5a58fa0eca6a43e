#pragma once

#include "hal/drm/drm_master.hpp"
#include "hal/projector.hpp"

#include <memory>
#include <string>

namespace bodyscan {

// A projector at a connector of the graphics card. After `close` it stays lit, black, so that it does not
// look for a signal; a projector that is lost is switched off.
class DrmProjector : public Projector {
 public:
  DrmProjector(std::shared_ptr<DrmMaster> master, ProjectorChoice choice);
  ~DrmProjector() override;

  Expected<void> open() override;
  [[nodiscard]] DisplayMode mode() const override { return choice_.mode; }
  Expected<std::int64_t> show(const GrayImage8& picture) override;
  void close() override;

 private:
  enum class State { closed, open, lost };

  [[nodiscard]] Expected<void> check_present() const;
  [[nodiscard]] tl::unexpected<Error> lose(const Error& reason);
  [[nodiscard]] std::string place() const;

  std::shared_ptr<DrmMaster> master_;
  ProjectorChoice choice_;
  State state_ = State::closed;
  ProjectorOutput output_;  // as it was when it was opened
  DisplayMode mode_;        // the calibrated one, as the output offers it
};

}  // namespace bodyscan
