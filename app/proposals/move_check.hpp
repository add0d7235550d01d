/**
 * @file
 * The checks that a move meets before anybody may approve it: what the kernel would refuse now is refused
 * here, with words. The kernel judges again, whatever this says.
 */
#pragma once

#include <string>
#include <tl/expected.hpp>

#include "motion/mailbox.hpp"
#include "proposals/check_list.hpp"
#include "proposals/proposal.hpp"
#include "robot/robot.hpp"

namespace interlock {

/**
 * Judges a draft against the newest view, in the kernel's order of checks.
 *
 * @param axis the axis that the draft names
 * @param config the configuration of the app's robot file; a kernel that runs another one moves nothing
 * @param checks makes the checks, after those that it has made before
 */
void check_move(const Axis& axis, const ilk_config_t& config, const ControlView& view, const MoveTask& move,
                CheckList& checks);

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

}  // namespace interlock
