/**
 * @file
 * P7 on the plant: what an axis that is not homed may do in one press of the pedal, judged by true positions.
 */
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "closed_loop.hpp"

namespace interlock::test {

class UnhomedBounds {
 public:
  /** Both must outlive the bounds. */
  UnhomedBounds(const ClosedLoop& loop, const Robot& robot) : loop_(loop), robot_(robot) {}

  /** To be called after every tick. Homing has bounds of its own, until it has ended. */
  void check() {
    const bool motion = loop_.state().system.mode == ILK_MODE_MOTION;
    const bool pressed = motion && !was_motion_;
    was_motion_ = motion;
    for (const Axis& axis : robot_.axes) {
      const ilk_axis_t& state = loop_.state().axis[axis.slot];
      const double position = loop_.true_position(axis.slot);
      if (pressed || state.homed != 0 || state.state == ILK_AXIS_HOMING) {
        from_[axis.slot] = position;
      } else if (motion) {
        ASSERT_LE(std::abs(position - from_[axis.slot]), axis.unhomed_travel_counts) << axis.name;
        ASSERT_LE(loop_.outputs().command[axis.slot].drive, axis.drive.unhomed_max) << axis.name;
      }
    }
  }

 private:
  const ClosedLoop& loop_;
  const Robot& robot_;
  std::array<double, ILK_SLOTS> from_{};
  bool was_motion_ = false;
};

}  // namespace interlock::test
