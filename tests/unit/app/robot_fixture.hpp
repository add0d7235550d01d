/**
 * @file
 * The robots' configuration, as every test of the app uses them.
 */
#pragma once

#include "motion/realtime_channel.hpp"
#include "project_robots.hpp"

namespace interlock::test {

/** Slots of the neuro robot: `insertion` has a switch, `rotation` has none. */
constexpr std::uint32_t yaw = 0;
constexpr std::uint32_t rotation = 1;
constexpr std::uint32_t pitch = 2;
constexpr std::uint32_t insertion = 3;
constexpr std::uint32_t empty_slot = 5;
/** The neuro robot's home step of two axes, yaw and pitch. */
constexpr std::uint32_t angles = 1;

constexpr std::uint32_t minute_ticks = 60000;

const ilk_config_t& neuro_config();
const ilk_config_t& prostate_config();

/** The kernel's configuration of a robot, which must be valid. */
ilk_config_t config_of(const Robot& robot);

/** A view of an attached kernel in READY, every axis homed at the middle of its range and enabled. */
ControlView ready_view();

/** As a hand or a motor moves an axis of that robot: its encoder counts along. */
void move(ControlView& view, std::uint32_t slot, std::int32_t counts);
ControlView ready_view(const Robot& robot);

/** The same of the prostate robot, its sliders parked and its needle out; both forces were read now. */
ControlView needle_view(std::uint32_t hand_counts = 1970, std::uint32_t needle_counts = 1780);

}  // namespace interlock::test
