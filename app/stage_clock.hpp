#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace bodyscan {

// Cuts time into stages, one after the other.
class StageClock {
 public:
  // The stage `name` is over; it began where the one before it ended.
  void end_stage(std::string name) {
    const auto now = std::chrono::steady_clock::now();
    stages_ms_.emplace_back(std::move(name), std::chrono::duration<double, std::milli>(now - begin_).count());
    begin_ = now;
  }

  [[nodiscard]] const std::vector<std::pair<std::string, double>>& stages_ms() const { return stages_ms_; }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::vector<std::pair<std::string, double>> stages_ms_;
};

}  // namespace bodyscan
