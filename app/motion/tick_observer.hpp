/**
 * @file
 * Somebody who is shown each tick on the control thread.
 */
#pragma once

#include "motion/realtime_channel.hpp"

namespace interlock {

class TickObserver {
 public:
  virtual ~TickObserver() = default;

  /** Called once a tick, after everything that moves the robot: it neither waits nor allocates. */
  virtual void see(const ControlView& view) noexcept = 0;

 protected:
  TickObserver() = default;
  TickObserver(const TickObserver&) = default;
  TickObserver& operator=(const TickObserver&) = default;
};

}  // namespace interlock
