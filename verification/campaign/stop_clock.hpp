/**
 * @file
 * Times each stop: from the fault that demands it to zero drive on the wire.
 *
 * It knows nothing of the monitors' reckoning: whoever causes a fault states by when the drive has to
 * be zero.
 */
#ifndef INTERLOCK_CAMPAIGN_STOP_CLOCK_HPP
#define INTERLOCK_CAMPAIGN_STOP_CLOCK_HPP

#include <array>
#include <cstdint>
#include <string_view>

#include "interlock/types.h"

namespace interlock::campaign {

/** Slot of what concerns no single axis. */
inline constexpr int kNoAxis = -1;

/** True when no outgoing frame drives anything. */
bool is_zero_drive(const ilk_outputs_t& outputs) noexcept;

/** Collects demands and reports those that were not met in time. Holds 64 at a time. */
class StopClock {
 public:
  /** Demands zero drive on every card, or on one axis, at some tick up to the deadline; false when there is
   * no room. */
  bool demand(std::uint32_t deadline, int axis, std::string_view reason) noexcept;

  /** Takes in what was sent in this tick; returns how many demands passed their deadline unmet. */
  std::uint32_t step(std::uint32_t tick, const ilk_outputs_t& sent) noexcept;

  /** Reason of the newest late stop; empty when none was. */
  std::string_view latest() const noexcept { return latest_; }

  /** Stops that came in time, since start. */
  std::uint64_t met() const noexcept { return met_; }

 private:
  struct Demand {
    bool open = false;
    std::uint32_t deadline = 0;
    int axis = kNoAxis;
    std::string_view reason;
  };

  std::array<Demand, 64> demands_{};
  std::uint32_t open_ = 0;
  std::uint64_t met_ = 0;
  std::string_view latest_;
};

}  // namespace interlock::campaign

#endif
