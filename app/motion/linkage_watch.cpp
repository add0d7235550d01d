#include "motion/linkage_watch.hpp"

#include <algorithm>

namespace interlock {
namespace {

/** A motion that was planned up to a bound may pass it by so much: it follows its path with an error. */
constexpr double tolerance_mm = 0.25;

bool is_driven(const ilk_axis_t& axis) noexcept {
  return axis.state == ILK_AXIS_MOVING || axis.state == ILK_AXIS_HOMING;
}

/** Whether it is known where the slider stands, or will stand. */
bool is_known(const ilk_axis_t& axis) noexcept { return axis.state == ILK_AXIS_HOMING || axis.homed != 0; }

}  // namespace

LinkageWatch::LinkageWatch(const Robot& robot) {
  if (robot.kinematics) {
    for (const SliderPair& pair : robot.kinematics->slider_pairs()) {
      pairs_.push_back({pair, slider(*robot.with_role(pair.left_role), 1.0),
                        slider(*robot.with_role(pair.right_role), -1.0)});
    }
  }
}

LinkageWatch::Slider LinkageWatch::slider(const Axis& axis, double outwards) {
  const double mm_per_count = outwards / axis.counts_per_unit;
  return {axis.slot, mm_per_count, axis.home_offset_counts * mm_per_count};
}

/** A slider that homes counts as if it stood at its switch already: nobody knows where it is. */
double LinkageWatch::outwards_mm(const Slider& slider, const ilk_axis_t& axis) noexcept {
  return axis.state == ILK_AXIS_HOMING ? slider.home_mm : axis.position_counts * slider.mm_per_count;
}

double LinkageWatch::beyond_mm(const Pair& pair, const ilk_axis_t& left, const ilk_axis_t& right) noexcept {
  if (!is_known(left) || !is_known(right)) {
    return 0.0;
  }
  const double separation_mm =
      pair.bounds.at_zero_mm + outwards_mm(pair.left, left) + outwards_mm(pair.right, right);
  return std::max(
      {0.0, separation_mm - pair.bounds.max_separation_mm, pair.bounds.min_separation_mm - separation_mm});
}

std::uint32_t LinkageWatch::see(const ilk_state_t& state) noexcept {
  std::uint32_t strained = 0;
  for (Pair& pair : pairs_) {
    const ilk_axis_t& left = state.axis[pair.left.slot];
    const ilk_axis_t& right = state.axis[pair.right.slot];
    const double now_mm = beyond_mm(pair, left, right);
    const bool is_moved = is_driven(left) || is_driven(right);
    pair.least_mm = is_moved ? std::min(pair.least_mm, now_mm) : now_mm;
    if (now_mm > pair.least_mm + tolerance_mm) {
      strained |= 1u << pair.left.slot | 1u << pair.right.slot;
    }
  }
  return strained;
}

}  // namespace interlock
