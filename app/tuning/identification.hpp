/**
 * @file
 * An axis of the simulated robot, measured under the real kernel core in this process. Nothing of the plant
 * is looked at but what a kernel sees.
 */
#pragma once

#include <cstdint>
#include <string>

#include "tuning/robot_changes.hpp"
#include "tuning/step_rig.hpp"

namespace interlock {

/**
 * Measures the axis of that name: some eighty moves within its range, at drives from the largest down to
 * where it stands. An axis that does not home with the drives of its file is homed with those of larger and
 * larger dead zones, up to the largest that the kernel accepts.
 *
 * The error says that the robot has no such axis, that it homes with no such drive, that its range is too
 * short to be measured in, that it stands where it has to move, or what ended a move.
 */
RigResult<Identified> identify(const Robot& robot, const ilk_config_t& config,
                               const plant::Parameters& parameters, const std::string& axis,
                               std::uint64_t seed);

/** Speed over drive as a picture: what was measured and the line through it. */
std::string identified_svg(const Identified& found, const std::string& title);

}  // namespace interlock
