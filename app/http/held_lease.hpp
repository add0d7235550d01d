/**
 * @file
 * The dead man's switch of what is held over the network: not renewed in time, it counts as let go.
 */
#pragma once

#include <chrono>
#include <cstdint>

#include "motion/mailbox.hpp"

namespace interlock::web {

class HeldLease {
 public:
  /** A time of the clock that leases run on. */
  using TimePoint = std::chrono::steady_clock::time_point;

  /** @param patience for which a hold lasts without a renewal */
  explicit HeldLease(std::chrono::milliseconds patience) : patience_(patience) {}

  /** The hold began, or was renewed. */
  void hold(const ControlView& view, TimePoint now);

  /** Lets go now. */
  void release() { held_ = false; }

  [[nodiscard]] bool held() const { return held_; }

  /**
   * Whether what is held was not renewed in time: of the kernel's in the simulated clock, so that a busy
   * machine lets nothing go, else of the wall's.
   */
  [[nodiscard]] bool overdue(const ControlView& view, TimePoint now) const;

 private:
  std::chrono::milliseconds patience_;
  bool held_ = false;
  TimePoint renewed_;
  std::uint32_t renewed_tick_ = 0;
};

}  // namespace interlock::web
