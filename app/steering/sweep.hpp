/**
 * @file
 * In which direction the needle turns: always on, or to and fro where the axis may not turn for ever.
 */
#pragma once

namespace interlock {

/**
 * Direction of a rotation that stays within one turn, as the published bidirectional mode does: it reverses
 * where the rotation has left the turn, and keeps its direction within.
 */
class Sweep {
 public:
  /** +1 or -1 at a rotation; the turn is that from 0 to 2 pi. A rotation that is no number keeps it. */
  double direction(double rotation_rad) noexcept;

 private:
  double direction_ = 1.0;
};

}  // namespace interlock
