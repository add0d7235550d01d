/**
 * @file
 * What navigation programs are told of the robot.
 */
#pragma once

#include <cstdint>
#include <vector>

#include "http/context.hpp"
#include "http/targeting.hpp"
#include "igtl/dialect.hpp"

namespace interlock::web {

/** Velocities of the axes, from two positions, as the kernel tells none. */
class AxisVelocities {
 public:
  /** Takes in what the control thread saw last. */
  void measure(const Robot& robot, const ControlView& view);

  /** Units/s, in the order of the robot's axes; empty while unknown. */
  [[nodiscard]] const std::vector<double>& units_per_s() const { return velocities_; }

 private:
  std::uint32_t tick_ = 0;
  std::vector<double> positions_; /**< at that tick */
  std::vector<double> velocities_;
};

igtl::RobotState robot_state(const Context& context, const Targeting& targeting,
                             const AxisVelocities& velocities);

}  // namespace interlock::web
