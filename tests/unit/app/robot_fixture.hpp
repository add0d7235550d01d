/**
 * @file
 * The neuro robot and its configuration, as every test of the app uses them.
 */
#pragma once

#include "motion/mailbox.hpp"
#include "robot/robot.hpp"

namespace interlock::test {

/** Slots of the neuro robot: a homeable axis, and one without a switch. */
constexpr std::uint32_t insertion = 3;
constexpr std::uint32_t rotation = 1;
constexpr std::uint32_t empty_slot = 5;

const Robot& neuro();
const ilk_config_t& neuro_config();

/** The kernel's configuration of a robot, which must be valid. */
ilk_config_t config_of(const Robot& robot);

/** A view of an attached kernel in READY, every axis homed at the middle of its range and enabled. */
ControlView ready_view();

}  // namespace interlock::test
