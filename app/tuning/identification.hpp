/**
 * @file
 * What the mechanics of an axis do, measured: by moves at one drive after the other, to and fro, on the
 * simulated robot under the real kernel core. Nothing of the plant is looked at but what a kernel sees.
 *
 * A move at a steady drive is a straight line of readings, `x = x0 + v (t - T)`. Its slope is the speed at
 * that drive; T is the lag of the motor, the two ticks of the loop, and after a reversal the time in which
 * the motor takes up the play. The dead zone is where the line of speed over drive meets zero.
 */
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "robot/robot_text.hpp"
#include "tuning/step_rig.hpp"

namespace interlock {

/** Steady speed at a drive; 0 where the axis stood. */
struct DriveSpeed {
  std::uint32_t drive = 0;
  double up_counts_per_s = 0.0;   /**< towards larger positions */
  double down_counts_per_s = 0.0; /**< towards smaller ones, positive */
};

/** What was measured of one axis. */
struct Identified {
  std::string axis;
  std::optional<std::string> homing_error = {}; /**< why it did not home with the drives of its file */
  std::uint32_t noise_counts = 0;               /**< peak to peak at rest, in five seconds */
  std::vector<DriveSpeed> speeds;       /**< largest drive first, down to the first at which the axis stood */
  double dead_zone_drive = 0.0;         /**< up to it the axis stands */
  double full_speed_counts_per_s = 0.0; /**< at the largest drive, in the faster direction */
  double fit_percent = 0.0;       /**< standard deviation of the speeds from their line, of full speed */
  double lag_s = 0.0;             /**< time constant of the speed */
  std::uint32_t coast_counts = 0; /**< farthest from the reading on which drive was last allowed until rest */
  double backlash_counts = 0.0;   /**< lost motion when the direction changes */
  std::optional<double> hysteresis_counts = {}; /**< from where the switch closes to where it opens */
};

/**
 * Measures the axis of that name: some eighty moves within its range, at drives from the largest down to
 * where it stands. An axis that does not home with the drives of its file is homed with those of larger and
 * larger dead zones, up to the largest that the kernel accepts.
 *
 * The error says that the robot has no such axis, that it homes with no such drive, that its range is too
 * short to be measured in, that it stands where it has to move, or what ended a move.
 */
RigResult<Identified> identify(const Robot& robot, const ilk_config_t& config,
                               const plant::Parameters& parameters, const std::string& axis,
                               std::uint64_t seed);

/** The axis with another dead zone: each of its drives is as far from there to the largest as it was before.
 */
Axis with_dead_zone(Axis axis, double dead_zone_drive);

/** A number that the file should have in place of another. */
struct NumberChange {
  AxisNumber number;
  double was = 0.0;
};

/**
 * What follows for the file of that axis, and only what differs: dead zone and full speed as measured, with
 * the drives of homing and of an axis that is not homed for the speeds that they were chosen for; rates of
 * planned motion that a slower axis can keep. What the kernel takes for the worst (coast, play, noise,
 * hysteresis, slowest speeds, and the bounds that rest on them) is made safer where it is not safe enough,
 * never the other way: the worst may not have shown itself.
 */
std::vector<NumberChange> changes_of(const Robot& robot, const Axis& axis, const Identified& found);

/** Speed over drive as a picture: what was measured and the line through it. */
std::string identified_svg(const Identified& found, const std::string& title);

}  // namespace interlock
