/**
 * @file
 * Jogs: moves that go on only for as long as somebody renews a short lease.
 *
 * Belongs to the network thread. The pedal stands above a jog as above every move.
 */
#pragma once

#include <cstdint>
#include <vector>

#include "http/held_lease.hpp"

namespace interlock::web {

class JogDesk {
 public:
  /** A time of the clock that leases run on. */
  using TimePoint = HeldLease::TimePoint;

  /** For which a jog goes on without a renewal. */
  static constexpr std::chrono::milliseconds patience{200};

  /** The jog that is this proposal began. */
  void begin(std::uint32_t proposal, const ControlView& view, TimePoint now);

  /** Goes on with a jog; false when it has ended, or was not renewed in time: it does not come back. */
  bool renew(std::uint32_t proposal, const ControlView& view, TimePoint now);

  /** Forgets a jog that has ended. */
  void end(std::uint32_t proposal);

  /** The proposals of the jogs that were not renewed in time. */
  [[nodiscard]] std::vector<std::uint32_t> lapsed(const ControlView& view, TimePoint now) const;

  /** The proposals of all jogs. */
  [[nodiscard]] std::vector<std::uint32_t> running() const;

 private:
  struct Jog {
    std::uint32_t proposal = 0;
    HeldLease lease{patience};
  };

  std::vector<Jog> jogs_;
};

}  // namespace interlock::web
