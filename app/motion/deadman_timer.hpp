/**
 * @file
 * The dead man's switch of what is held over the network: not renewed in time, it counts as let go.
 */
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace interlock {

/** A moment, by both clocks that a hold can run on. */
struct Moment {
  std::chrono::steady_clock::time_point time;
  std::uint32_t tick = 0;
  /** Length of a tick of the simulated clock, which counts then, so that a busy machine lets nothing go; 0:
   * the wall's time counts. */
  std::uint32_t tick_us = 0;
};

/** Whether something is still held. */
class DeadmanTimer {
 public:
  /** @param timeout for which a hold lasts without a renewal */
  explicit DeadmanTimer(std::chrono::milliseconds timeout) : timeout_(timeout) {}

  /** The hold began, or was renewed. */
  void hold(const Moment& now) noexcept { renewed_ = now; }

  /** Lets go now. */
  void release() noexcept { renewed_.reset(); }

  [[nodiscard]] bool held() const noexcept { return renewed_.has_value(); }

  /** Whether what is held was not renewed in time. */
  [[nodiscard]] bool overdue(const Moment& now) const noexcept;

 private:
  std::chrono::milliseconds timeout_;
  std::optional<Moment> renewed_; /**< while it is held */
};

}  // namespace interlock
