/**
 * @file
 * What the axes did during one motion, and what its mode wanted of them: as a table and as a picture.
 */
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "control/setpoint.hpp"
#include "robot/robot.hpp"

namespace interlock {

/** An axis at one moment. */
struct AxisSample {
  std::int32_t position_counts = 0;   /**< as the kernel reads it */
  double velocity_counts_per_s = 0.0; /**< of the simulated axis, true */
  std::optional<Setpoint> setpoint;   /**< nothing: the mode does not move the axis now */
  std::uint32_t drive = 0;            /**< that the kernel gives */
};

/** What the axes did in one motion. */
struct MotionRecord {
  std::vector<double> times_s;               /**< since the motion was ordered */
  std::vector<std::vector<AxisSample>> axes; /**< in the order of the robot's axes; one sample each time */

  /** Whether the mode ever moved the axis. */
  [[nodiscard]] bool moved(std::size_t axis) const;
};

/**
 * Header and a row for each time: time_s, position, setpoint, velocity, setpoint_velocity in the unit of the
 * axis and seconds, error_counts (setpoint less position) and drive. Setpoints and error are empty while the
 * axis has none.
 */
std::string motion_csv(const MotionRecord& record, std::size_t axis, const Axis& described);

/** The same as an SVG document: position, velocity with the jerk-limited profile that it follows, error. */
std::string motion_svg(const MotionRecord& record, std::size_t axis, const Axis& described,
                       const std::string& title);

}  // namespace interlock
