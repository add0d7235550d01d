/**
 * @file
 * Motion of one axis as pieces of constant jerk.
 */
#pragma once

#include <vector>

#include "robot/motion_rates.hpp"

namespace interlock {

// Where an axis is and how it moves, in the axis' unit (mm or rad) and seconds.

/** Position and its first two derivatives. */
struct MotionState {
  double position = 0.0;
  double velocity = 0.0;
  double acceleration = 0.0;

  bool operator==(const MotionState&) const = default;
};

constexpr MotionState operator+(const MotionState& one, const MotionState& other) noexcept {
  return {one.position + other.position, one.velocity + other.velocity,
          one.acceleration + other.acceleration};
}

constexpr MotionState operator-(const MotionState& state) noexcept {
  return {-state.position, -state.velocity, -state.acceleration};
}

/** Positions between which an axis may be, both ends in it. */
struct PositionRange {
  double lowest = 0.0;
  double highest = 0.0;

  bool operator==(const PositionRange&) const = default;
};

/** Motion of constant jerk: a cubic in time, of which trajectories and plans are put together. */
struct CubicSegment {
  MotionState start;
  double jerk = 0.0;

  /** The cubic from one position and velocity to others (Hermite); `duration_s` is above 0. */
  static CubicSegment between(double from, double from_velocity, double to, double to_velocity,
                              double duration_s) noexcept;

  /** The straight line from one position to another; `duration_s` is above 0. */
  static CubicSegment line(double from, double to, double duration_s) noexcept;

  /** The state that long after the start. */
  [[nodiscard]] MotionState after(double time_s) const noexcept;

  /** Widens `range` to the start and to where the motion turns; its end is the start of the next piece. */
  void widen(PositionRange& range, double duration_s) const noexcept;

  /** Largest speed from start to end, both in it. */
  [[nodiscard]] double top_speed(double duration_s) const noexcept;
};

/** Widens `range` to hold `position`. */
void widen(PositionRange& range, double position) noexcept;

/** The motion of one axis as pieces of constant jerk, one after the other, and then rest. */
class PiecewiseMotion {
 public:
  /** Goes on with a piece; one that takes no time is left out. */
  void append(const CubicSegment& piece, double duration_s);

  /** Ends at rest. Whoever made the pieces answers for it that they lead there. */
  void end_at(double position);

  /** Until it is at rest. */
  [[nodiscard]] double duration_s() const noexcept { return duration_s_; }

  /** The state that long after the start: that of the start before 0 and for a time that is no number. */
  [[nodiscard]] MotionState at(double time_s) const noexcept;

  /** When each piece begins, the rest at the end included. */
  [[nodiscard]] std::vector<double> boundaries_s() const;

  /** The positions that it passes through. */
  [[nodiscard]] PositionRange reach() const noexcept;

 private:
  struct Piece {
    double begin_s = 0.0;
    CubicSegment motion;
  };

  std::vector<Piece> pieces_;
  double duration_s_ = 0.0;
};

}  // namespace interlock
