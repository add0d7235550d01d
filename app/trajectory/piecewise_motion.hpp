/**
 * @file
 * The motion of one axis as pieces of constant jerk, one after the other, and then rest.
 */
#pragma once

#include <vector>

#include "trajectory/jerk_piece.hpp"
#include "trajectory/motion_state.hpp"

namespace interlock {

class PiecewiseMotion {
 public:
  /** Goes on with a piece; one that takes no time is left out. */
  void append(const JerkPiece& piece, double duration_s);

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
    JerkPiece motion;
  };

  std::vector<Piece> pieces_;
  double duration_s_ = 0.0;
};

}  // namespace interlock
