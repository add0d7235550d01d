/**
 * @file
 * The checks that a biopsy meets before anybody may approve it.
 */
#pragma once

#include <tl/expected.hpp>

#include "motion/mailbox.hpp"
#include "proposals/move_check.hpp"

namespace interlock {

/**
 * Judges a biopsy against the newest view: CONFIG_MISMATCH, MODE, for insertion and rotation FAULTED,
 * DISABLED, BUSY while homing and NOT_HOMED, then FORCE_STALE when the force is older than 20 ms, IN_TISSUE
 * when the tip is past the skin already, so that nobody knows where it is, and RANGE when the insertion does
 * not reach the target's depth.
 */
void check_biopsy(const Robot& robot, const ilk_config_t& config, const ControlView& view,
                  const BiopsyTask& asked, CheckList& checks);

}  // namespace interlock
