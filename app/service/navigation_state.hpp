/**
 * @file
 * What navigation programs are told of the robot.
 */
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "igtl/dialect.hpp"
#include "service/context.hpp"
#include "service/targeting.hpp"

namespace interlock {

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

/** Velocity of a pose that is seen again and again. */
class PoseVelocity {
 public:
  /** The pose at that tick; none: it is not known. */
  void measure(std::uint32_t tick, std::uint32_t period_us, const std::optional<igtl::Matrix>& pose);

  /** Along and about the axes of the frame in which the poses are, mm/s and rad/s. */
  [[nodiscard]] const std::optional<igtl::Spatial>& per_s() const { return velocity_; }

 private:
  std::uint32_t tick_ = 0;
  std::optional<igtl::Matrix> pose_; /**< at that tick */
  std::optional<igtl::Spatial> velocity_;
};

igtl::RobotState robot_state(const Context& context, const Targeting& targeting,
                             const AxisVelocities& velocities);

}  // namespace interlock
