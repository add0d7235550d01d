/**
 * @file
 * A robot as its file describes it: axes and sensors by card slot, their bounds, units and names, its
 * kinematics, its modes and the steps of homing.
 *
 * A `Robot` comes from `load_robot` (robot_file.hpp) and turns into the kernel's configuration by `compile`
 * (compile.hpp). It is a plain value: copy it, hand it between threads.
 *
 * Units live in the names, as in the kernel: `_counts` encoder counts, `_ticks` control periods, `_ms`
 * milliseconds. Drive is the kernel's speed magnitude, 0 to `max`.
 */
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interlock/types.h"
#include "kinematics/family.hpp"
#include "robot/biopsy.hpp"
#include "robot/motion_rates.hpp"
#include "robot/robot_error.hpp"
#include "robot/sensor.hpp"
#include "robot/unit.hpp"

namespace interlock {

/** Kind of motor behind a card. */
enum class Motor { unspecified, shinsei, piezo, dti };

/** "unspecified", "shinsei", "piezo" or "dti". */
std::string_view motor_name(Motor motor);

/** Positions between which a homed axis may be. */
struct SoftLimits {
  std::int32_t min_counts = 0;
  std::int32_t max_counts = 0;

  bool operator==(const SoftLimits&) const = default;
};

/** Bounds of the drive. */
struct DriveBounds {
  std::uint32_t max = 0;
  std::uint32_t min = 0;       /**< smallest drive that a controller asks for while it moves the axis */
  std::uint32_t dead_zone = 0; /**< largest drive that does not move the axis */
  std::uint32_t unhomed_max = 0;
  std::uint32_t max_amplitude = 0; /**< wave amplitude; 0 unless the card is high-frequency */
  double resonance_hz =
      0.0; /**< of the motor, above the published map; 0 unless the card is high-frequency */

  bool operator==(const DriveBounds&) const = default;
};

/** Smallest drive that a controller asks for: what the file says, or a 32nd of the way from the dead
 * zone to the largest. */
constexpr std::uint32_t floor_drive(const DriveBounds& drive) noexcept {
  constexpr std::uint32_t fraction = 32;
  return drive.min != 0 ? drive.min : drive.dead_zone + (drive.max - drive.dead_zone) / fraction;
}

/** Gains of the controller along a path (control/piv_controller.hpp), whatever the axis' counts, speed and
 * card. */
struct Gains {
  double position_per_s = 0.0; /**< velocity for a count of position error */
  double velocity = 0.0;       /**< output for a velocity error */
  double integral_per_s = 0.0; /**< growth of the output for a velocity error */

  bool operator==(const Gains&) const = default;
};

/** What the mechanics do by themselves. */
struct Mechanics {
  std::uint32_t coast_counts =
      0; /**< farthest travel from the reading on which drive was last allowed until rest */
  std::uint32_t backlash_counts = 0;         /**< of the encoder, when the direction changes */
  std::uint32_t noise_counts = 0;            /**< peak-to-peak noise of the counter at rest */
  std::uint32_t max_delta_counts = 0;        /**< largest possible motion in one tick */
  std::uint32_t rest_ticks = 0;              /**< ticks without motion that are rest */
  std::uint32_t full_speed_counts_per_s = 0; /**< highest speed, of the unloaded axis at `drive.max` */
  /** Between encoder and tool, unknown to the kernel; nothing: nobody measured it. Kinematics hold for an
   * axis that came from below; one that came from above has its tool up to so much beyond. */
  std::optional<std::uint32_t> tool_play_counts = {};

  bool operator==(const Mechanics&) const = default;
};

/** Homing at the switch; only axes with a switch have it. */
struct Homing {
  std::uint32_t drive = 0;
  std::uint32_t amplitude = 0;               /**< wave amplitude; 0 unless the card is high-frequency */
  std::uint32_t slow_drive = 0;              /**< of the second approach to the switch */
  std::uint32_t speed_counts_per_s = 0;      /**< slowest speed at `drive` */
  std::uint32_t slow_speed_counts_per_s = 0; /**< slowest speed at `slow_drive` */
  std::uint32_t travel_counts = 0;           /**< farthest travel of homing in one press of the pedal */
  std::uint32_t timeout_ticks = 0;           /**< longest homing in one press of the pedal */
  std::uint32_t clear_counts = 0; /**< every back-off ends at least this far from where the switch changed */
  std::uint32_t tolerance_counts = 0;  /**< the two edges of homing agree within this */
  std::uint32_t hysteresis_counts = 0; /**< the switch opens this far from where it closes, at most */

  bool operator==(const Homing&) const = default;
};

/** When a driven axis counts as stalled. */
struct StallRule {
  std::uint32_t driven_ticks = 0;
  std::uint32_t effort_ticks = 0; /**< ticks of full drive without progress; 0: the axis is too slow for it */
  std::uint32_t min_counts = 0;   /**< progress that clears the driven ticks */

  bool operator==(const StallRule&) const = default;
};

/** Motion that nobody asked for. */
struct RunawayRule {
  std::uint32_t reverse_counts = 0; /**< tolerated against the command */
  std::uint32_t drift_counts = 0;   /**< tolerated while not driven */

  bool operator==(const RunawayRule&) const = default;
};

/** One motor axis. The slot of its card is its number everywhere. */
struct Axis {
  std::uint32_t slot = 0;
  std::string name;  /**< for programs and files: "probe_rotation" */
  std::string title; /**< for people: "Probe rotation" */
  std::string role;  /**< in the robot's kinematics, one of its joints; empty when it plays none */
  ilk_card_t card = ILK_CARD_NONE; /**< NONE: not known yet, so the robot does not compile */
  bool required = false;           /**< losing its card ends MOTION of all axes */
  Motor motor = Motor::unspecified;
  std::uint32_t encoder_resolution = 0; /**< counts per revolution of the motor */
  Unit unit = Unit::mm;
  double counts_per_unit = 1.0;
  std::uint32_t motor_direction = 0;      /**< 1: the card's direction bit follows the axis, 0: inverted */
  std::uint32_t direction_correction = 0; /**< 1: position decreases while the raw counter increases */
  ilk_limit_side_t limit = ILK_LIMIT_NONE;
  std::int32_t home_offset_counts = 0; /**< position at the edge of the switch */
  std::uint32_t deadband_counts = 0;
  std::uint32_t unhomed_travel_counts = 0; /**< farthest travel in one press of the pedal while not homed */
  SoftLimits soft_limits;
  DriveBounds drive;
  Gains gains;
  Mechanics mechanics;
  StallRule stall;
  RunawayRule runaway;
  std::optional<Homing> homing;
  std::optional<MotionRates> motion; /**< without them the axis moves alone only */

  /** Counts in the axis' unit. */
  [[nodiscard]] double to_unit(std::int32_t counts) const;

  /** Nearest count to a position in the axis' unit; empty when it is not finite or beyond 32 bits. */
  [[nodiscard]] std::optional<std::int32_t> to_counts(double position) const;

  /** Whether a position in the axis' unit is, to a count, within its soft limits. */
  [[nodiscard]] bool reaches(double position) const;

  /** Lowest setpoint that the kernel accepts from the axis, homed at its switch if it has one. */
  [[nodiscard]] std::int32_t lowest_setpoint_counts() const;

  /** Highest setpoint that the kernel accepts from the axis, homed at its switch if it has one. */
  [[nodiscard]] std::int32_t highest_setpoint_counts() const;

  /** Setpoint below `counts` from which an axis that goes there takes up its tool's play, wherever it came
   * from. Nothing when it has none, or no room for it. */
  [[nodiscard]] std::optional<std::int32_t> take_up_counts(std::int32_t counts) const;

  /** Whether the kernel accepts that setpoint from the homed axis. */
  [[nodiscard]] bool accepts_setpoint(std::int32_t counts) const;

  bool operator==(const Axis&) const = default;
};

/** Foot pedal. */
struct Pedal {
  std::uint32_t channels = 2; /**< 1: normally open contact, 2: normally closed contact besides */
  std::uint32_t debounce_ticks = 0;
  std::uint32_t disagree_ticks = 0; /**< disagreement of the channels that locks */

  bool operator==(const Pedal&) const = default;
};

/** Limits of the control loop, its bus and the app that speaks to it. */
struct LoopLimits {
  std::uint32_t app_timeout_ticks = 0;     /**< silence of the app that ends MOTION */
  std::uint32_t lease_max_ticks = 0;       /**< longest lease of a move */
  std::uint32_t power_up_ticks = 0;        /**< from power on until the amplifiers obey */
  std::uint32_t switch_debounce_ticks = 0; /**< valid readings in a row that make an edge of a switch count */
  std::uint32_t bad_frame_limit = 0;       /**< bad frames in a row that lose a card, or the bus */
  std::uint32_t overrun_limit = 0;         /**< missed deadlines in a row that lock */

  bool operator==(const LoopLimits&) const = default;
};

/** Travel of one axis: a distance for a nudge, a position for a move. */
struct AxisCounts {
  std::uint32_t slot = 0;
  std::int32_t counts = 0;

  bool operator==(const AxisCounts&) const = default;
};

/**
 * One step of homing the robot. Exactly one of `home`, `nudge` and `move` is not empty; its axes go together,
 * and the next step begins when all have arrived.
 */
struct HomeStep {
  std::string name;                /**< for programs: "probe_out" */
  std::string title;               /**< for people: "Probe out" */
  std::vector<std::uint32_t> home; /**< slots of axes that go to their switches */
  std::vector<AxisCounts> nudge; /**< signed distances by which axes go: at most their `unhomed_travel_counts`
                                    in each press of the pedal, or once homed to their soft limits at most */
  std::vector<AxisCounts> move;  /**< setpoints of axes that homed in an earlier step */

  bool operator==(const HomeStep&) const = default;
};

/** How navigation programs reach the robot by OpenIGTLink. */
struct OpenIgtLink {
  std::string bind = "127.0.0.1"; /**< address to listen on */
  std::uint32_t port = 18944;
  std::string dialect = "thesis"; /**< thesis, brp2013 or wpi2024 */
  std::vector<std::string> allow; /**< addresses that may connect; empty: this machine's own */
  std::uint32_t heartbeat_ms =
      0;                       /**< silence by which the controller counts as lost; 0: igtl/igtl_server.hpp */
  std::string connect_address; /**< of a program that listens, to which the app connects, too; empty: none */
  std::uint32_t connect_port = 0;
  /** The first connection is the controller of whoever is in control, without being asked. */
  bool first_controls = false;

  bool operator==(const OpenIgtLink&) const = default;
};

/** Where a robot stands in the scanner when it is set up as it should be: its zFrame in RAS. */
struct ExpectedRegistration {
  PointMm origin_mm{};
  PointMm origin_tolerance_mm{};     /**< of each coordinate, either way */
  std::array<double, 9> rotation{};  /**< row by row */
  double rotation_tolerance_deg = 0; /**< of the turn from that */

  bool operator==(const ExpectedRegistration&) const = default;
};

/** What is believed of an aim. */
struct TargetingLimits {
  double tolerance_mm = 0;  /**< by which the reached treatment point may miss the desired one */
  double tolerance_deg = 0; /**< by which the way in may */
  ExpectedRegistration registration;

  bool operator==(const TargetingLimits&) const = default;
};

/** The robot. Axes are in the order of the file, in which people see them. */
struct Robot {
  std::string name;
  std::string title;
  std::string revision; /**< of the whole file, eight hex digits: another one for whatever is changed in it */
  std::string text;     /**< the whole file, as it was read */
  std::uint32_t period_us = 1000;
  std::vector<std::string> modes; /**< ways of moving it; the first is the one in which it starts */
  bool auto_approve = false;      /**< no motion needs approval */
  Pedal pedal;
  LoopLimits loop;
  std::string family = "none"; /**< of its kinematics: "neuro_rcm" */
  KinematicsPtr kinematics;    /**< null: its axes move one by one, and it has no pose */
  /** Standard deviation of the treatment point along each coordinate that remains after the kinematics was
   * calibrated, in mm; empty: nobody has stated it. */
  std::optional<double> calibration_mm;
  ProbeOffsets probe;        /**< until somebody sets others */
  TargetingLimits targeting; /**< with kinematics */
  std::vector<Axis> axes;
  std::vector<Sensor> sensors;
  std::vector<HomeStep> home_steps; /**< in the order in which they run; each axis with a switch homes once */
  std::vector<AxisCounts> draping; /**< setpoints of the mode "draping"; the other axes stay where they are */
  std::optional<Biopsy> biopsy;    /**< of the mode "cooperative_biopsy" */
  std::optional<OpenIgtLink> openigtlink; /**< none: it does not listen for them */
  Origin origin;

  /** The axis of that name, or null. */
  [[nodiscard]] const Axis* find(std::string_view axis_name) const;

  /** The axis in that slot, or null. */
  [[nodiscard]] const Axis* at_slot(std::uint32_t slot) const;

  /** The axis that plays that role in the kinematics, or null. */
  [[nodiscard]] const Axis* with_role(std::string_view role) const;

  /** The sensor of that name, or null. */
  [[nodiscard]] const Sensor* find_sensor(std::string_view sensor_name) const;

  /** The sensor in that slot, or null. */
  [[nodiscard]] const Sensor* sensor_at_slot(std::uint32_t slot) const;

  /** The step of homing of that name, or null. */
  [[nodiscard]] const HomeStep* find_home_step(std::string_view step_name) const;

  /** Whether the file gives the robot this mode. */
  [[nodiscard]] bool has_mode(std::string_view mode) const;
};

}  // namespace interlock
