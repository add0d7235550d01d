/**
 * @file
 * The dead man's switch of a pedal that is held over the network: not renewed in time, it counts as released.
 */
#pragma once

#include <chrono>
#include <cstdint>

#include "motion/mailbox.hpp"

namespace interlock::web {

class BenchPedal {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /** The pedal was pressed, or its hold renewed. */
  void hold(const ControlView& view, TimePoint now);

  void release() { held_ = false; }

  [[nodiscard]] bool held() const { return held_; }

  /**
   * Whether a held pedal was not renewed for 500 ms: of the kernel's time in the simulated clock, so that a
   * busy machine releases nothing, else of the wall's.
   */
  [[nodiscard]] bool overdue(const ControlView& view, TimePoint now) const;

 private:
  bool held_ = false;
  TimePoint renewed_;
  std::uint32_t renewed_tick_ = 0;
};

}  // namespace interlock::web
