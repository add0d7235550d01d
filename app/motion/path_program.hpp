/**
 * @file
 * What several axes are to do together: legs, one after the other.
 *
 * It never changes once a task has it.
 */
#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "robot/robot.hpp"
#include "trajectory/timed_trajectory.hpp"

namespace interlock {

/** Axes to positions, jerk-limited, arriving together; the others stay where they are. */
struct MoveLeg {
  std::vector<AxisCounts> targets; /**< each slot at most once */
  double minimum_duration_s = 0.0;
  double dwell_s = 0.0; /**< rest at the targets */
  /** It begins only once somebody has looked at what was reached before, and confirmed it. */
  bool needs_confirmation = false;
  /** It leaves its axes below the targets of the leg behind it, on whose way their tools' play is taken up.
   */
  bool takes_up_play = false;
};

/** First to where the trajectory begins, as a `MoveLeg` would, then along it in time. */
struct TimedLeg {
  TimedTrajectory trajectory;
};

/** One part of a path. */
using PathLeg = std::variant<MoveLeg, TimedLeg>;

/** What a straight line of the treatment point keeps to. */
struct LineFigures {
  double length_mm = 0.0;
  double allowed_mm = 0.0; /**< largest deviation that was asked for */
  double planned_mm = 0.0; /**< bound of the planned one: of the treatment point from its line, and of the
                              probe's axis from the entry point, or from the direction at the entry */
  bool keeps_direction = false; /**< else the probe goes on passing through its entry point */
};

/** A whole path, leg by leg. */
struct PathProgram {
  std::vector<PathLeg> legs;
  /** Of a straight line: its one leg is right only from where the robot stood when it was made. */
  std::optional<LineFigures> line = std::nullopt;

  /** Bit n: a leg moves the axis in slot n. */
  [[nodiscard]] std::uint32_t mask() const noexcept;
};

/** Bit n: the leg moves the axis in slot n. */
[[nodiscard]] std::uint32_t mask_of(const PathLeg& leg) noexcept;

}  // namespace interlock
