/**
 * @file
 * The checks that a motion of several axes meets before anybody may approve it, and what it will look like.
 */
#pragma once

#include <tl/expected.hpp>
#include <vector>

#include "motion/path_program.hpp"
#include "proposals/move_check.hpp"

namespace interlock {

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

}  // namespace interlock
