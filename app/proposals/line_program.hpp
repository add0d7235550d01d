/**
 * @file
 * Straight lines of the treatment point, from where the robot stands.
 *
 * The treatment point T goes from T₀ to T₀ + L u, and the probe comes from an entry point E: one that stays
 * (the probe turns about it, as about a remote centre), or one that goes along (the probe keeps its
 * direction). At s mm of the way the axes are at the inverse kinematics of (E(s), T(s)) with the probe turned
 * as it is; velocities there are its derivative by s, times ds/dt of the minimum-jerk course
 *
 *     s = L (10 τ³ - 15 τ⁴ + 6 τ⁵),   τ = t / duration                    (T. Flash, N. Hogan, 1985)
 *
 * and between these rows each axis follows its quintics (trajectory/timed_trajectory.hpp). Rows are added
 * until what lies between them is near enough to the line; then the time is made longer until every axis
 * keeps its rates.
 *
 * Deviation: the larger of the distance of T from the line, and of the distance of E, at the same s, from the
 * axis of the probe. It is sampled eight times between two rows; with e the deviation as a vector, the bound
 * is the largest |e| and an eighth, doubled for what the difference of second order leaves out, of the
 * largest second difference of e: a function is no farther from the chord of a step h than h²/8 |e''|.
 */
#pragma once

#include "motion/path_program.hpp"
#include "proposals/check_list.hpp"
#include "targeting/robot_kinematics.hpp"

namespace interlock {

/** The straight line that somebody asks for; points in the zFrame, mm. */
struct LineRequest {
  Eigen::Vector3d end_mm = Eigen::Vector3d::Zero(); /**< of the treatment point */
  /** Through which the probe goes on passing; nothing: it keeps its direction. */
  std::optional<Eigen::Vector3d> entry_mm = std::nullopt;
  double deviation_mm = 0.0; /**< largest that the plan may have */
  double speed_mm_s = 0.0;   /**< largest of the treatment point, before an axis slows it down */
};

/** Lengths of a line, mm. */
inline constexpr double shortest_line_mm = 0.1;
inline constexpr double longest_line_mm = 1000.0;

/**
 * The line from the positions `from` of all axes, as one leg of the axes that it moves.
 *
 * Refused, where it is about a place with how far along the line that is: OUT_OF_RANGE for a line that is too
 * short or too long, OFF_AXIS when the probe's axis misses the entry by more than the deviation, INSERTED for
 * a line across the probe while that is not out as far as it goes and keeps its direction, the code of the
 * kinematics where the line leaves the reach or passes a singular pose, RANGE where the kernel would refuse
 * an axis' position, NO_LINE where the rows come to no end, and the code of the trajectory.
 */
tl::expected<PathProgram, Refusal> line_program(const Robot& robot, const RobotKinematics& kinematics,
                                                const AxisPositions& from, const LineRequest& request);

/** The entry point of the probe at these positions: where the robot has it; nothing, where the joints fix
 * none. zFrame, mm. */
std::optional<Eigen::Vector3d> entry_at(const RobotKinematics& kinematics, const AxisPositions& positions);

}  // namespace interlock
