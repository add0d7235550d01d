/**
 * @file
 * A step response on the simulated robot: the run, its figures, its table and its plot.
 */
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "control/axis_controller.hpp"
#include "tuning/step_rig.hpp"

namespace interlock {

// A step of one axis: a move along the velocity profile of the thesis, made by the axis' controller on the
// simulated plant under the real kernel core, recorded tick by tick.

/** Gains to try instead of those of the robot file. */
struct AskedGains {
  std::optional<double> position_per_s = {};
  std::optional<double> velocity = {};
  std::optional<double> integral_per_s = {};
};

/** What step is run. */
struct StepOptions {
  std::string axis; /**< its name in the robot file */
  std::optional<std::int32_t> move_counts =
      {}; /**< from where it stands once homed; default: `default_move` */
  std::optional<double> cruise_counts_per_s = {}; /**< of the profile; default: five sixths of full speed */
  std::optional<double> full_speed_counts_per_s = {}; /**< that the controller believes in; default: the
                                                    published map's, or that of the plant */
  AskedGains gains = {};
  std::uint32_t late_ticks = 0; /**< by which each MOVE comes later than over a link that is never late */
  std::uint64_t seed = 1;       /**< of the plant's noise */
};

/** One control tick, at the moment of its reading. Positions and velocities in counts and seconds. */
struct StepRow {
  double time_s = 0.0;              /**< since the start of the profile */
  std::int32_t position_counts = 0; /**< as the kernel reads it */
  Setpoint setpoint;
  double true_position_counts = 0.0; /**< of the plant, in the frame of the readings */
  double true_velocity_counts_per_s = 0.0;
  std::optional<double> estimated_velocity_counts_per_s;
  std::uint32_t drive = 0; /**< that the controller asked for */
};

/** What the axis did in a step. */
struct StepRun {
  std::string axis;
  std::int32_t from_counts = 0;
  std::int32_t target_counts = 0;
  std::uint32_t deadband_counts = 0;
  std::uint32_t max_drive = 0;
  double period_s = 0.0;
  double peak_counts_per_s = 0.0; /**< largest speed of the profile */
  double duration_s = 0.0;        /**< of the profile */
  std::vector<StepRow> rows;      /**< until `after_profile_s` after it */
};

/** Longer profiles are refused: a run is kept whole, a row a tick. */
inline constexpr double longest_profile_s = 600.0;

/** How long a run goes on after its profile. */
inline constexpr double after_profile_s = 1.0;

/** Away from the switch, or upwards: what full speed makes in 0.6 s, which is the thesis' move for its yaw,
 * or half of the way that there is. */
std::int32_t default_move(const Axis& axis, std::int32_t from_counts, double full_speed_counts_per_s);

/**
 * Makes the run.
 *
 * The error says which option has no meaning for this robot, or what ended the motion and when.
 */
RigResult<StepRun> run_step(const Robot& robot, const ilk_config_t& config,
                            const plant::Parameters& parameters, const StepOptions& options);

/** How good a step was, in numbers. */
struct StepFigures {
  double rms_velocity_error_percent = 0.0; /**< true velocity against the profile's at the same time, over the
                                              whole profile, of its peak */
  double largest_position_error_counts =
      0.0;                             /**< true position against the profile's, over the whole profile */
  std::int32_t final_error_counts = 0; /**< last reading less target */
  double overshoot_counts = 0.0;       /**< farthest true position beyond the target */
  std::optional<double> settle_ms; /**< from the end of the profile until the encoder, without noise, stays
                                      within the deadband; nothing if it does not */
};

/** The figures of a run, which has at least one row. */
StepFigures figures_of(const StepRun& run);

// A run as a table: a row for each control tick.

/**
 * Header and rows with the columns time_s, position_counts (as read), setpoint_counts,
 * velocity_counts_per_s (true), setpoint_velocity_counts_per_s, drive and
 * estimated_velocity_counts_per_s, which is empty while it is not known.
 */
std::string step_csv(const StepRun& run);

// A run as a picture: position, velocity and control output over time, one above the other.

/** A whole SVG document that needs nothing else. `title` may hold any text. */
std::string step_svg(const StepRun& run, const std::string& title);

}  // namespace interlock
