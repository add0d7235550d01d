/**
 * @file
 * What a wish for homing means for this robot, and whether it may be granted now.
 */
#pragma once

#include <cstdint>
#include <string>
#include <tl/expected.hpp>

#include "motion/mailbox.hpp"
#include "proposals/move_check.hpp"
#include "robot/robot.hpp"

namespace interlock {

/** Homing of one axis alone; of the step of that name (NOT_FOUND: there is none); of all steps (NOT_FOUND:
 * the robot has none). */
HomeTask home_axis(std::uint32_t slot);
tl::expected<HomeTask, Refusal> home_step(const Robot& robot, const std::string& name);
tl::expected<HomeTask, Refusal> home_all(const Robot& robot);

/**
 * Judges homing against the newest view: CONFIG_MISMATCH, MODE, then for each axis FAULTED and DISABLED,
 * then NO_SWITCH, then NOT_HOMED where a step goes to a position and no earlier step homes the axis, and last
 * SEPARATION (separation.hpp).
 */
void check_home(const Robot& robot, const ilk_config_t& config, const ControlView& view, const HomeTask& plan,
                CheckList& checks);

}  // namespace interlock
