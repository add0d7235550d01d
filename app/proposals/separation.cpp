#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinematics/kinematics.hpp"
#include "motion/setpoint_range.hpp"
#include "proposals/checks.hpp"

namespace interlock {
namespace {

/** What a step does to a slider, at worst. */
struct Effect {
  bool outwards = false;  /**< it may drive the slider outwards */
  PositionRange after_mm; /**< once the step has ended well */
};

/** One slider; all mm are outwards, away from the other slider of its pair. */
class Slider {
 public:
  Slider(const Axis& axis, bool upwards_is_outwards, const ilk_axis_t& state)
      : axis_(axis),
        counts_per_mm_(upwards_is_outwards ? axis.counts_per_unit : -axis.counts_per_unit),
        is_homed_(state.homed != 0),
        range_mm_{to_mm(axis.soft_limits.min_counts), to_mm(axis.soft_limits.min_counts)} {
    widen(range_mm_, to_mm(axis.soft_limits.max_counts));
    reach_mm_ = is_homed_ ? at(state.position_counts) : range_mm_;
  }

  [[nodiscard]] const Axis& axis() const { return axis_; }
  [[nodiscard]] bool is_homed() const { return is_homed_; }
  [[nodiscard]] double to_mm(std::int32_t counts) const { return counts / counts_per_mm_; }
  [[nodiscard]] double to_counts(double mm) const { return mm * counts_per_mm_; }

  /** Motion in mm of the axis as motion outwards. */
  [[nodiscard]] MotionPiece outwards(const MotionPiece& motion) const {
    return counts_per_mm_ > 0.0 ? motion : -motion;
  }

  /** Where it may stand. */
  [[nodiscard]] const PositionRange& reach_mm() const { return reach_mm_; }
  void arrive(const PositionRange& reach_mm) { reach_mm_ = reach_mm; }
  void may_reach(std::int32_t counts) { widen(reach_mm_, to_mm(counts)); }

  [[nodiscard]] Effect effect_of(const HomeStep& step) const {
    if (std::find(step.home.begin(), step.home.end(), axis_.slot) != step.home.end()) {
      return going_to(axis_.home_offset_counts);
    }
    if (const AxisCounts* move = travel_in(step.move)) {
      return going_to(move->counts);
    }
    if (const AxisCounts* nudge = travel_in(step.nudge)) {
      const double by_mm = to_mm(nudge->counts);
      return {by_mm > 0.0, {within_range(reach_mm_.lowest + by_mm), within_range(reach_mm_.highest + by_mm)}};
    }
    return {false, reach_mm_};
  }

 private:
  [[nodiscard]] PositionRange at(std::int32_t counts) const { return {to_mm(counts), to_mm(counts)}; }
  [[nodiscard]] Effect going_to(std::int32_t counts) const {
    return {to_mm(counts) > reach_mm_.lowest, at(counts)};
  }
  [[nodiscard]] double within_range(double mm) const {
    return std::clamp(mm, range_mm_.lowest, range_mm_.highest);
  }
  [[nodiscard]] const AxisCounts* travel_in(const std::vector<AxisCounts>& travels) const {
    const auto found = std::find_if(travels.begin(), travels.end(),
                                    [this](const AxisCounts& each) { return each.slot == axis_.slot; });
    return found == travels.end() ? nullptr : &*found;
  }

  const Axis& axis_;
  double counts_per_mm_; /**< signed */
  bool is_homed_;
  PositionRange range_mm_;
  PositionRange reach_mm_;
};

struct Pair {
  Slider left;
  Slider right;
  SliderPair bounds;

  /** Separations of sliders in two reaches. */
  [[nodiscard]] PositionRange separation_mm(const PositionRange& one, const PositionRange& other) const {
    return {bounds.at_zero_mm + one.lowest + other.lowest, bounds.at_zero_mm + one.highest + other.highest};
  }
};

std::vector<Pair> pairs_of(const Robot& robot, const AxisStates& axes) {
  std::vector<Pair> pairs;
  const auto slider = [&](std::string_view role, bool upwards_is_outwards) {
    const Axis& axis = *robot.with_role(role);
    return Slider(axis, upwards_is_outwards, axes[axis.slot]);
  };
  if (robot.kinematics) {
    for (const SliderPair& pair : robot.kinematics->slider_pairs()) {
      pairs.push_back({slider(pair.left_role, true), slider(pair.right_role, false), pair});
    }
  }
  return pairs;
}

std::string in_mm(double mm) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f mm", mm);
  return text;
}

/** `separation_mm` is beyond one of the bounds. */
Refusal beyond_linkage(const Pair& pair, double separation_mm) {
  const Axis& left = pair.left.axis();
  const Axis& right = pair.right.axis();
  const bool is_too_far = separation_mm > pair.bounds.max_separation_mm;
  const bool is_known = pair.left.is_homed() && pair.right.is_homed();
  const std::string bounds =
      "from " + in_mm(pair.bounds.min_separation_mm) + " to " + in_mm(pair.bounds.max_separation_mm);
  return {"SEPARATION",
          left.name + " and " + right.name + (is_known ? " would" : " could") +
              (is_too_far ? " part by " : " come as near as ") + in_mm(separation_mm) +
              (is_known ? "." : "; one that is not homed may be anywhere in its range."),
          "a separation " + bounds,
          is_known ? "Choose targets between which the linkage is not " +
                         std::string(is_too_far ? "stretched." : "pressed together.")
                   : "Run all home steps, or home the other slider first (Set Home where it has no switch)."};
}

tl::expected<void, Refusal> check_within(const Pair& pair, const PositionRange& separation_mm) {
  if (separation_mm.highest > pair.bounds.max_separation_mm) {
    return tl::make_unexpected(beyond_linkage(pair, separation_mm.highest));
  }
  if (separation_mm.lowest < pair.bounds.min_separation_mm) {
    return tl::make_unexpected(beyond_linkage(pair, separation_mm.lowest));
  }
  return {};
}

/** How a slider moves outwards from one row to the next; nothing when the trajectory does not move it. */
std::optional<MotionPiece> motion_of(const Slider& slider, const TimedTrajectory& trajectory,
                                     std::size_t row) {
  const auto& axes = trajectory.axes();
  const auto moved = std::find_if(axes.begin(), axes.end(), [&slider](const TrajectoryAxis& axis) {
    return axis.slot == slider.axis().slot;
  });
  if (moved == axes.end()) {
    return std::nullopt;
  }
  return slider.outwards(trajectory.piece(static_cast<std::size_t>(moved - axes.begin()), row));
}

/** Judges what a trajectory does to a pair from one row to the next. */
tl::expected<void, Refusal> check_row(const Pair& pair, const TimedTrajectory& trajectory, std::size_t row) {
  const auto left = motion_of(pair.left, trajectory, row);
  const auto right = motion_of(pair.right, trajectory, row);
  if (!left && !right) {
    return {};
  }
  const MotionPiece both = left.value_or(MotionPiece{}) + right.value_or(MotionPiece{});
  const double start = both.after(0.0).position;
  PositionRange moved{start, start};
  both.widen(moved, trajectory.step_s(row));
  const PositionRange none;
  const PositionRange rest =
      pair.separation_mm(left ? none : pair.left.reach_mm(), right ? none : pair.right.reach_mm());
  return check_within(pair, {rest.lowest + moved.lowest, rest.highest + moved.highest});
}

tl::expected<void, Refusal> run(Pair& pair, const HomeStep& step) {
  const Effect left = pair.left.effect_of(step);
  const Effect right = pair.right.effect_of(step);
  const double separation_mm = pair.bounds.at_zero_mm +
                               std::max(pair.left.reach_mm().highest, left.after_mm.highest) +
                               std::max(pair.right.reach_mm().highest, right.after_mm.highest);
  if ((left.outwards || right.outwards) && separation_mm > pair.bounds.max_separation_mm) {
    return tl::make_unexpected(beyond_linkage(pair, separation_mm));
  }
  pair.left.arrive(left.after_mm);
  pair.right.arrive(right.after_mm);
  return {};
}

/** The slider of that slot, and the other one. */
struct Sides {
  const Slider* slider = nullptr;
  Slider* other = nullptr;
};

Sides sides_of(Pair& pair, std::uint32_t slot) {
  if (pair.left.axis().slot == slot) {
    return {&pair.left, &pair.right};
  }
  return pair.right.axis().slot == slot ? Sides{&pair.right, &pair.left} : Sides{};
}

}  // namespace

std::optional<std::uint32_t> linked_to(const Robot& robot, std::uint32_t slot) {
  for (Pair& pair : pairs_of(robot, {})) {
    if (const Slider* other = sides_of(pair, slot).other) {
      return other->axis().slot;
    }
  }
  return std::nullopt;
}

AxisStates states_of(const ControlView& view) { return std::to_array(view.snapshot.state.axis); }

tl::expected<void, Refusal> check_separation(const Robot& robot, const AxisStates& axes,
                                             std::span<const HomeStep> steps) {
  for (Pair& pair : pairs_of(robot, axes)) {
    for (const HomeStep& step : steps) {
      if (auto stays = run(pair, step); !stays) {
        return stays;
      }
    }
  }
  return {};
}

tl::expected<void, Refusal> check_separation(const Robot& robot, const AxisStates& axes,
                                             std::uint32_t moved) {
  for (const Pair& pair : pairs_of(robot, axes)) {
    const bool is_moved = ((moved >> pair.left.axis().slot | moved >> pair.right.axis().slot) & 1u) != 0;
    const PositionRange separation = pair.separation_mm(pair.left.reach_mm(), pair.right.reach_mm());
    if (auto stays = check_within(pair, separation); is_moved && !stays) {
      return stays;
    }
  }
  return {};
}

tl::expected<void, Refusal> check_separation(const Robot& robot, const AxisStates& axes,
                                             const TimedTrajectory& trajectory) {
  for (const Pair& pair : pairs_of(robot, axes)) {
    for (std::size_t row = 0; row < trajectory.rows(); ++row) {
      if (auto stays = check_row(pair, trajectory, row); !stays) {
        stays.error().detail = "After row " + std::to_string(row + 1) + ": " + stays.error().detail;
        return stays;
      }
    }
  }
  return {};
}

tl::expected<void, Refusal> check_separation(const Robot& robot, const AxisStates& axes,
                                             std::span<const AxisCounts> headed, const AxisCounts& move) {
  for (Pair& pair : pairs_of(robot, axes)) {
    const auto [slider, other] = sides_of(pair, move.slot);
    if (slider == nullptr || !slider->is_homed()) {
      continue;
    }
    for (const AxisCounts& each : headed) {
      if (each.slot == other->axis().slot) {
        other->may_reach(each.counts);
      }
    }
    const double target_mm = slider->to_mm(move.counts);
    const PositionRange apart = pair.separation_mm({target_mm, target_mm}, other->reach_mm());
    const double here_mm = slider->reach_mm().lowest;
    if (target_mm > here_mm && apart.highest > pair.bounds.max_separation_mm) {
      return tl::make_unexpected(beyond_linkage(pair, apart.highest));
    }
    if (target_mm < here_mm && apart.lowest < pair.bounds.min_separation_mm) {
      return tl::make_unexpected(beyond_linkage(pair, apart.lowest));
    }
  }
  return {};
}

std::int32_t linked_end(const Robot& robot, const AxisStates& axes, const AxisCounts& move) {
  const std::int32_t here = axes[move.slot].position_counts;
  std::int32_t end = move.counts;
  for (Pair& pair : pairs_of(robot, axes)) {
    const auto [slider, other] = sides_of(pair, move.slot);
    if (slider == nullptr || !slider->is_homed()) {
      continue;
    }
    const PositionRange& reach = other->reach_mm();
    const SliderPair& bounds = pair.bounds;
    const auto [low, high] =
        std::minmax({slider->to_counts(bounds.min_separation_mm - bounds.at_zero_mm - reach.lowest),
                     slider->to_counts(bounds.max_separation_mm - bounds.at_zero_mm - reach.highest)});
    end = end > here ? std::min(end, saturated(std::llround(std::floor(high))))
                     : std::max(end, saturated(std::llround(std::ceil(low))));
  }
  const bool leads_there = move.counts > here ? end > here : end < here;
  return leads_there ? end : move.counts;
}

}  // namespace interlock
