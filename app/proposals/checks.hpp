/**
 * @file
 * The checks that a proposal passes before anybody may approve it.
 */
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "control/frequency_map.hpp"
#include "motion/path_program.hpp"
#include "motion/realtime_channel.hpp"
#include "proposals/check_list.hpp"
#include "proposals/proposal.hpp"
#include "robot/robot.hpp"
#include "trajectory/timed_trajectory.hpp"

namespace interlock {

// The checks that a move meets before anybody may approve it: what the kernel would refuse now is refused
// here, with words. The kernel judges again, whatever this says.

/** Whether the kernel runs the app's configuration: CONFIG_MISMATCH. */
tl::expected<void, Refusal> check_configuration(const ilk_config_t& config, const ControlView& view);

/** Whether the kernel runs the app's configuration and takes motion at all: CONFIG_MISMATCH, MODE. */
void check_system(const ilk_config_t& config, const ControlView& view, CheckList& checks);

/** Whether the axis may be moved by anybody: FAULTED, DISABLED. An axis that is homing may. */
tl::expected<void, Refusal> check_axis(const Axis& axis, const ControlView& view);

/** Whether the axis may be moved to a position: as `check_axis`, and BUSY while it is homing. */
tl::expected<void, Refusal> check_free_axis(const Axis& axis, const ControlView& view);

/** "12 counts (0.254 mm)" */
std::string counts_and_unit(const Axis& axis, std::int32_t counts);

/** A refusal in the words of the catalog's verdict. */
Refusal verdict_refusal(std::uint32_t verdict, const std::string& where, const std::string& expected = "");

// Whether a motion could part two sliders that carry one linkage farther than it allows, or press it
// together.
//
// The kernel looks at each axis by itself and cannot forbid it. An axis that is not homed is taken to be
// anywhere between its soft limits; what a step does to it narrows that for the steps after it. The axes of a
// step may race each other in any way.

/** States of axes by slot, with the positions from which a motion is to begin. */
using AxisStates = std::array<ilk_axis_t, ILK_SLOTS>;

/** As the kernel reported them. */
AxisStates states_of(const ControlView& view);

/** The other slider of the pair to which the axis in that slot belongs; nothing where it is none. */
std::optional<std::uint32_t> linked_to(const Robot& robot, std::uint32_t slot);

/**
 * Judges home steps one after the other, from where the axes stand: SEPARATION when one may drive a slider
 * outwards although its pair could then part farther than the linkage allows. Steps that bring sliders
 * together are allowed wherever they stand.
 */
tl::expected<void, Refusal> check_separation(const Robot& robot, const AxisStates& axes,
                                             std::span<const HomeStep> steps);

/** Judges axes at rest: SEPARATION when two linked sliders, one of which was moved (bit n for slot n), stand
 * too far apart or too near. On a straight way between two places where they do not they never do. */
tl::expected<void, Refusal> check_separation(const Robot& robot, const AxisStates& axes, std::uint32_t moved);

/** Judges a trajectory: SEPARATION when two linked sliders could part too far, or come too near, between two
 * of its rows. A slider that the trajectory does not move stands at its position. */
tl::expected<void, Refusal> check_separation(const Robot& robot, const AxisStates& axes,
                                             const TimedTrajectory& trajectory);

/**
 * Judges a move of one axis: SEPARATION when it would lead beyond the linkage; one that leads back to where
 * the linkage allows it may always be made. An axis that is not homed is led by eye, and passes.
 *
 * @param headed targets of the other axes that may be on their way
 */
tl::expected<void, Refusal> check_separation(const Robot& robot, const AxisStates& axes,
                                             std::span<const AxisCounts> headed, const AxisCounts& move);

/** How far a move of one axis may go on the way to its target; the target where it may not go at all. */
std::int32_t linked_end(const Robot& robot, const AxisStates& axes, const AxisCounts& move);

// What a request for homing means for this robot, and whether it may be granted now.

/** Homing of one axis alone; of the step of that name (NOT_FOUND: there is none); of all steps (NOT_FOUND:
 * the robot has none). */
HomeTask home_axis(std::uint32_t slot);
tl::expected<HomeTask, Refusal> home_step(const Robot& robot, const std::string& name);
tl::expected<HomeTask, Refusal> home_all(const Robot& robot);

// The checks that a motion of several axes meets before anybody may approve it, and what it will look like.

/** What a program will do from where the axes are now. */
struct PathPreview {
  std::vector<AxisCounts> ends; /**< where each axis comes to rest at the end, in the order of the slots */
  double duration_s = 0.0;      /**< of the planned motion; settling at the end of each leg is not in it */
};

/** Whether each axis of the mask, bit n for slot n, may go to a position: FAULTED, DISABLED or BUSY of any,
 * then NOT_HOMED. */
void check_axes(const Robot& robot, const ControlView& view, std::uint32_t mask, CheckList& checks);

/**
 * Judges a program against the newest view, leg by leg, from where the axes are: CONFIG_MISMATCH, MODE, then
 * for each axis FAULTED, DISABLED and BUSY while homing, then NOT_HOMED, then RANGE for each target,
 * SEPARATION where linked sliders would part too far, and NO_PATH where no motion within the rates leads
 * there.
 */
tl::expected<PathPreview, Refusal> check_path(const Robot& robot, const ilk_config_t& config,
                                              const ControlView& view, const PathProgram& program,
                                              CheckList& checks);

// Sweeps of frequency: the band of an axis, the frequencies between two ends, and the checks that a sweep
// meets before anybody may approve it.

/** Frequencies that the kernel packs for an axis: a lower one turns it faster. */
struct FrequencyBand {
  double lowest_hz = 0.0;  /**< that of the largest drive */
  double highest_hz = 0.0; /**< that of the smallest drive that moves the axis */
};

/** The published sweep: 0x48000000 down to 0x40000000 in steps of 1 000 000, a second each. */
inline constexpr FrequencyBand published_sweep{frequency_map::hz_of(0x40000000),
                                               frequency_map::hz_of(0x48000000)};
inline constexpr double published_sweep_step_hz = 1e6 / frequency_map::words_per_hz;
inline constexpr double published_sweep_dwell_s = 1.0;

/** Of the robot file's bounds on drive; empty for an axis without a high-frequency card. */
std::optional<FrequencyBand> frequency_band(const Axis& axis) noexcept;

/**
 * The frequencies from one to the other, both in Hz and above 0, as far as whole steps lead.
 *
 * @return empty when they are more than `FrequencySteps::most`, or a step is not above 0
 */
std::optional<FrequencySteps> frequency_steps(double from_hz, double to_hz, double step_hz,
                                              std::uint32_t dwell_ticks) noexcept;

/** The whole band of the axis, from its slowest frequency on, in published steps of a second each. */
std::optional<FrequencySteps> whole_band(const Axis& axis, std::uint32_t period_us) noexcept;

/**
 * Judges a sweep against the newest view: CONFIG_MISMATCH, MODE, FAULTED, DISABLED, BUSY while homing,
 * NOT_HOMED, then DRIVE for frequencies outside of the band, which it names.
 */
void check_sweep(const Robot& robot, const ilk_config_t& config, const ControlView& view,
                 const SweepTask& sweep, CheckList& checks);

}  // namespace interlock
