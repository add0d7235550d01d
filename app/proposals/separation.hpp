/**
 * @file
 * Whether homing or a path could part two sliders that carry one linkage farther than it allows.
 *
 * The kernel looks at each axis by itself and cannot forbid it. An axis that is not homed is taken to be
 * anywhere between its soft limits; what a step does to it narrows that for the steps after it. The axes of a
 * step may race each other in any way.
 */
#pragma once

#include <array>
#include <span>
#include <tl/expected.hpp>

#include "motion/mailbox.hpp"
#include "proposals/move_check.hpp"
#include "robot/robot.hpp"
#include "trajectory/timed_trajectory.hpp"

namespace interlock {

/**
 * Judges home steps one after the other, from where the axes stand in the view: SEPARATION when one may drive
 * a slider outwards although its pair could then part farther than the linkage allows.
 */
tl::expected<void, Refusal> check_separation(const Robot& robot, const ControlView& view,
                                             std::span<const HomeStep> steps);

/**
 * Judges homed axes at rest: SEPARATION when two linked sliders stand too far apart. On a straight way
 * between two such places they never do.
 *
 * @param positions counts by slot
 */
tl::expected<void, Refusal> check_separation(const Robot& robot,
                                             const std::array<std::int32_t, ILK_SLOTS>& positions);

/**
 * Judges a trajectory: SEPARATION when two linked sliders could part too far between two of its rows. A
 * slider that the trajectory does not move stands at its position.
 */
tl::expected<void, Refusal> check_separation(const Robot& robot,
                                             const std::array<std::int32_t, ILK_SLOTS>& positions,
                                             const TimedTrajectory& trajectory);

}  // namespace interlock
