/**
 * @file
 * Programs of paths for the modes that make them from few numbers.
 */
#pragma once

#include <optional>

#include "motion/path_program.hpp"
#include "robot/modes.hpp"
#include "targeting/alignment.hpp"

namespace interlock {

// From angles and depths of the probe to the motion of the mode "ablation".

/** One place at which the probe rests. */
struct AblationStep {
  double probe_rotation_rad = 0.0;
  double insertion_mm = 0.0;
  double dwell_s = 0.0;

  bool operator==(const AblationStep&) const = default;
};

/** The mode that `can_ablate` is about. */
inline constexpr RobotMode ablation_mode{"ablation"};

/** Whether the robot's file has the mode and the axes for it. */
bool can_ablate(const Robot& robot);

/** The probe to one place; nothing when an encoder does not reach so far. Of a robot that can ablate. */
std::optional<MoveLeg> ablation_leg(const Robot& robot, const AblationStep& step);

// From an alignment to the motion that reaches it.

/**
 * Takes the probe out as far as it goes, moves all other axes together to their setpoints, then, with
 * `insert`, inserts the probe. A robot without insertion moves in one leg.
 */
PathProgram pose_program(const Robot& robot, const Alignment& alignment, bool insert);

/**
 * The program with a leg before each to positions, in which its axes go together to where their tools' play
 * is taken up on the way (`Axis::take_up_counts`): then each arrives from below, where kinematics hold. An
 * axis without play goes to its target with them. No such leg where the leg before leaves all of them below.
 *
 * The insertion goes in last, and so from below. While it is `inserted`, only what moves along and about the
 * probe takes its play up: the other axes would move it sideways for that.
 */
PathProgram arriving_from_below(const Robot& robot, PathProgram program, bool inserted = false);

}  // namespace interlock
