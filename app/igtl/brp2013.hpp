/**
 * @file
 * The dialect of the prostate robots' protocol as its public tests have it (2013): any phase may be asked for
 * at any time, and the phase's own STATUS says whether it can be had.
 */
#pragma once

#include "igtl/workphases.hpp"

namespace interlock::igtl {

class Brp2013 final : public Workphases {
 protected:
  [[nodiscard]] std::string forbids(Phase wanted, const RobotState& state) const override;
  [[nodiscard]] bool tells_every_entry() const noexcept override { return false; }
  [[nodiscard]] StatusCode uncalibrated() const noexcept override { return StatusCode::not_ready; }
  [[nodiscard]] bool takes_reachable() const noexcept override { return false; }
  [[nodiscard]] bool takes_target() const noexcept override { return phase() == Phase::targeting; }
};

}  // namespace interlock::igtl
