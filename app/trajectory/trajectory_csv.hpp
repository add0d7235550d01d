/**
 * @file
 * Reads a trajectory from text: a header, then rows of numbers, with commas between the fields.
 *
 *     time [s],yaw [rad],insertion [mm],insertion [mm/s]
 *     0,-0.5,10,0
 *     1.5,-0.6,12,0
 *
 * Lines end in LF or CRLF, the last one perhaps in nothing; blanks around a field and a byte order mark do
 * not count. Quotes, comments and empty lines are not part of the format. Numbers have a decimal point
 * whatever the language of the machine, and no plus sign.
 */
#pragma once

#include <string_view>

#include "trajectory/trajectory_builder.hpp"

namespace interlock {

/** Longer texts are refused unread. */
inline constexpr std::size_t most_trajectory_bytes = std::size_t{64} << 20;

/** The trajectory, or the first thing in the text that keeps it from being one; see `TrajectoryBuilder`. */
TrajectoryResult<TimedTrajectory> read_trajectory(std::string_view text, const Robot& robot,
                                                  Timing timing = Timing::as_written);

}  // namespace interlock
