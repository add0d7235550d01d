/**
 * @file
 * Of which axes a person may declare that they stand at home.
 */
#pragma once

#include "proposals/checks.hpp"
#include "robot/robot.hpp"

namespace interlock {

/** Whether a switch tells where the axis' home is. */
[[nodiscard]] bool has_switch(const Axis& axis);

/**
 * HAS_SWITCH: a declared home that is wrong moves the soft limit at the end that the switch does not guard,
 * and nothing else stops the axis there.
 */
[[nodiscard]] Refusal switch_knows_home(const Axis& axis);

}  // namespace interlock
