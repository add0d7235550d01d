/**
 * @file
 * Watches linked sliders while they are driven. What a motion could do to a linkage is judged before it is
 * approved, by where the sliders stand then; a hand may push one of them afterwards.
 */
#pragma once

#include <cstdint>
#include <vector>

#include "interlock/types.h"
#include "kinematics/kinematics.hpp"
#include "robot/robot.hpp"

namespace interlock {

/** Finds driven sliders that strain their linkage. Nothing allocates but the construction. */
class LinkageWatch {
 public:
  explicit LinkageWatch(const Robot& robot);

  /** Looks at a state of the kernel. Bit n: motion of the axis in slot n has to end, since it brings its pair
   * further beyond a bound than the pair was at rest. Motion that brings the pair back goes on. */
  [[nodiscard]] std::uint32_t see(const ilk_state_t& state) noexcept;

 private:
  struct Slider {
    std::uint32_t slot;
    double mm_per_count; /**< outwards, away from the other slider; signed */
    double home_mm;      /**< at the edge of its switch */
  };

  struct Pair {
    SliderPair bounds;
    Slider left;
    Slider right;
    double least_mm = 0.0; /**< how far it was beyond a bound, at the least since the motion began */
  };

  static Slider slider(const Axis& axis, double outwards);
  static double outwards_mm(const Slider& slider, const ilk_axis_t& axis) noexcept;
  static double beyond_mm(const Pair& pair, const ilk_axis_t& left, const ilk_axis_t& right) noexcept;

  std::vector<Pair> pairs_;
};

}  // namespace interlock
