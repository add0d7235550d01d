/**
 * @file
 * Times each stop: from the fault that demands it to zero drive on the wire.
 *
 * It knows nothing of the oracle's reckoning: whoever causes a fault states by when the drive has to be zero.
 */
#ifndef INTERLOCK_ORACLE_STOP_CLOCK_HPP
#define INTERLOCK_ORACLE_STOP_CLOCK_HPP

#include <array>
#include <cstdint>
#include <span>

#include "oracle/finding.hpp"
#include "oracle/rules.hpp"
#include "oracle/wire.hpp"

namespace interlock::oracle {

/** Collects demands and reports those that were not met in time. Holds 64 at a time. */
class StopClock {
 public:
  /** Demands zero drive on every card, or on one axis, at some tick up to the deadline; false when there is
   * no room. */
  bool demand(std::uint32_t deadline, std::int8_t axis, std::string_view reason) noexcept;

  /** Takes in what was sent in this tick; returns how many demands passed their deadline unmet. */
  std::uint32_t step(std::uint32_t tick, std::span<const wire::FrameView> to_card) noexcept;

  /** Reason of the newest late stop; empty when none was. */
  std::string_view latest() const noexcept { return latest_; }

  /** Stops that came in time, since start. */
  std::uint64_t met() const noexcept { return met_; }

 private:
  struct Demand {
    bool open = false;
    std::uint32_t deadline = 0;
    std::int8_t axis = kNoAxis;
    std::string_view reason;
  };

  std::array<Demand, 64> demands_{};
  std::uint32_t open_ = 0;
  std::uint64_t met_ = 0;
  std::string_view latest_;
};

}  // namespace interlock::oracle

#endif
