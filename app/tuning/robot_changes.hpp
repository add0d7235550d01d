/**
 * @file
 * What follows for a robot's file from what was measured of an axis, on the simulated hardware or on a
 * running robot.
 */
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "robot/robot.hpp"
#include "robot/robot_text.hpp"
#include "tuning/axis_measurement.hpp"

namespace interlock {

/** What was measured of one axis. */
struct Identified : MeasuredAxis {
  std::string axis = {};
  std::optional<std::string> homing_error = {}; /**< why it did not home with the drives of its file */
  std::optional<double> hysteresis_counts = {}; /**< from where the switch closes to where it opens */
};

/** Its figures by name, in the units that the names say: docs/tuning.md. */
nlohmann::ordered_json to_json(const Identified& found);

/** The axis with another dead zone: each of its drives is as far from there to the largest as it was before.
 */
Axis with_dead_zone(Axis axis, double dead_zone_drive);

/** A number that the file should have in place of another. */
struct NumberChange {
  AxisNumber number;
  double was = 0.0;
};

/** As a list of key, was and is. */
nlohmann::ordered_json to_json(const std::vector<NumberChange>& changes);

/**
 * What follows for the file of that axis, and only what differs: dead zone, resonance and full speed as
 * measured, with the drives of homing and of an axis that is not homed for the speeds that they were chosen
 * for; rates of planned motion that a slower axis can keep. What the kernel takes for the worst (coast, play,
 * noise, hysteresis, slowest speeds, and the bounds that rest on them) is made safer where it is not safe
 * enough, never the other way: the worst may not have shown itself.
 */
std::vector<NumberChange> changes_of(const Robot& robot, const Axis& axis, const Identified& found);

/**
 * Whether numbers of the file may follow from it. Not when the speeds lie off their line over drive by more
 * than 2 % of full speed, or off the published map moved to their resonance where that drives the motor: then
 * the motor was another one at the end of the measurement than at its beginning (warm, its resonance
 * elsewhere), or has no such line, and dead zone and lag mean nothing.
 */
tl::expected<void, RobotError> believable(const Robot& robot, const std::string& axis,
                                          const Identified& found);

/** The robot's file with the changes, all else as it stands; the error is that of a file which the kernel
 * would refuse. `name` is that of the new file, for the error. */
tl::expected<std::string, RobotError> changed_file(const Robot& robot, const std::string& name,
                                                   const std::string& axis,
                                                   std::span<const NumberChange> changes);

/** The lines in which two texts of equally many lines differ, with three lines around them, as `patch` reads
 * it; empty where none does. */
std::string unified_diff(std::string_view was, std::string_view now, const std::string& name);

}  // namespace interlock
