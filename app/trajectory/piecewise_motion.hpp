/**
 * @file
 * Motion of one axis as polynomials in time, one after the other.
 */
#pragma once

#include <array>
#include <cstdint>
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

/** Positions between which an axis may be, both ends in it. */
struct PositionRange {
  double lowest = 0.0;
  double highest = 0.0;

  bool operator==(const PositionRange&) const = default;
};

/** Which derivative of the position. */
enum class Rate : std::uint8_t { velocity = 1, acceleration = 2, jerk = 3 };

/** The largest magnitude of a rate, and when. */
struct Peak {
  double magnitude = 0.0;
  double time_s = 0.0;
};

/** A polynomial of the fifth degree at most, of which trajectories and plans are put together. */
class MotionPiece {
 public:
  /** Rest at 0. */
  MotionPiece() = default;

  /** Constant jerk from a state on. */
  MotionPiece(const MotionState& start, double jerk) noexcept;

  /** From one state to another; `duration_s` is above 0. Three derivatives at either end are six conditions:
   * the quintic of Hermite. */
  static MotionPiece between(const MotionState& from, const MotionState& to, double duration_s) noexcept;

  /** The state that long after the start. */
  [[nodiscard]] MotionState after(double time_s) const noexcept;

  /** Widens `range` to all positions from start to end, both in it. */
  void widen(PositionRange& range, double duration_s) const noexcept;

  /** Raises `peak` to the largest magnitude of a rate from start to end, both in it; the time of a higher one
   * counts from the start. True: it was higher. */
  bool raise(Peak& peak, Rate rate, double duration_s) const noexcept;

  /** Both motions at once. */
  friend MotionPiece operator+(const MotionPiece& one, const MotionPiece& other) noexcept;
  /** The other way. */
  friend MotionPiece operator-(const MotionPiece& piece) noexcept;

 private:
  std::array<double, 6> terms_{}; /**< position = sum of terms_[n] t^n */
};

/** Widens `range` to hold `position`. */
void widen(PositionRange& range, double position) noexcept;

/** The motion of one axis as pieces, one after the other, and then rest. */
class PiecewiseMotion {
 public:
  /** Goes on with a piece; one that takes no time is left out. */
  void append(const MotionPiece& piece, double duration_s);

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
    MotionPiece motion;
  };

  std::vector<Piece> pieces_;
  double duration_s_ = 0.0;
};

}  // namespace interlock
