#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "kinematics/kinematics.hpp"
#include "proposals/checks.hpp"

namespace interlock {
namespace {

/** Where a slider may stand: mm from the middle of its rail, outwards is up on either side. */
struct Reach {
  double inner_mm = 0.0;
  double outer_mm = 0.0;
};

/** What a step does to a slider, at worst. */
struct Sweep {
  bool outwards = false; /**< it may drive the slider outwards */
  Reach after;           /**< once the step has ended well */
};

class Slider {
 public:
  Slider(const Axis& axis, bool upwards_is_outwards, const ilk_axis_t& state)
      : axis_(axis), per_mm_(upwards_is_outwards ? axis.counts_per_unit : -axis.counts_per_unit) {
    const SoftLimits& limits = axis.soft_limits;
    const double ends_mm[] = {to_mm(limits.min_counts), to_mm(limits.max_counts)};
    range_ = {std::min(ends_mm[0], ends_mm[1]), std::max(ends_mm[0], ends_mm[1])};
    reach_ = state.homed != 0 ? at(state.position_counts) : range_;
  }

  [[nodiscard]] const Axis& axis() const { return axis_; }

  /** How far outwards that position is. */
  [[nodiscard]] double outwards_mm(std::int32_t counts) const { return to_mm(counts); }

  /** Motion in mm as motion outwards. */
  [[nodiscard]] CubicSegment outwards(CubicSegment motion) const {
    return per_mm_ > 0.0 ? motion : CubicSegment{-motion.start, -motion.jerk};
  }

  [[nodiscard]] const Reach& reach() const { return reach_; }
  void arrive(const Reach& reach) { reach_ = reach; }

  [[nodiscard]] Sweep sweep_of(const HomeStep& step) const {
    if (std::find(step.home.begin(), step.home.end(), axis_.slot) != step.home.end()) {
      return sweep_to(axis_.home_offset_counts);
    }
    if (const AxisCounts* move = travel_in(step.move)) {
      return sweep_to(move->counts);
    }
    if (const AxisCounts* nudge = travel_in(step.nudge)) {
      const double by_mm = to_mm(nudge->counts);
      return {by_mm > 0.0, {within_range(reach_.inner_mm + by_mm), within_range(reach_.outer_mm + by_mm)}};
    }
    return {false, reach_};
  }

 private:
  [[nodiscard]] double to_mm(std::int32_t counts) const { return counts / per_mm_; }
  [[nodiscard]] Reach at(std::int32_t counts) const { return {to_mm(counts), to_mm(counts)}; }
  [[nodiscard]] Sweep sweep_to(std::int32_t counts) const {
    return {to_mm(counts) > reach_.inner_mm, at(counts)};
  }
  [[nodiscard]] double within_range(double mm) const {
    return std::clamp(mm, range_.inner_mm, range_.outer_mm);
  }
  [[nodiscard]] const AxisCounts* travel_in(const std::vector<AxisCounts>& travels) const {
    const auto found = std::find_if(travels.begin(), travels.end(),
                                    [this](const AxisCounts& each) { return each.slot == axis_.slot; });
    return found == travels.end() ? nullptr : &*found;
  }

  const Axis& axis_;
  double per_mm_; /**< counts, signed */
  Reach range_;
  Reach reach_;
};

struct Pair {
  Slider left;
  Slider right;
  double most_mm;
};

/** The pairs, each slider in the state in which `state_of(slot)` says that it is. */
template <typename StateOf>
std::vector<Pair> pairs_of(const Robot& robot, const StateOf& state_of) {
  std::vector<Pair> pairs;
  const auto slider = [&](std::string_view role, bool upwards_is_outwards) {
    const Axis& axis = *robot.with_role(role);
    return Slider(axis, upwards_is_outwards, state_of(axis.slot));
  };
  if (robot.kinematics) {
    for (const SliderPair& pair : robot.kinematics->slider_pairs()) {
      pairs.push_back({slider(pair.left_role, true), slider(pair.right_role, false), pair.max_separation_mm});
    }
  }
  return pairs;
}

std::string in_mm(double mm) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f mm", mm);
  return text;
}

Refusal too_far(const Pair& pair, double separation_mm) {
  const std::string left = pair.left.axis().name;
  const std::string right = pair.right.axis().name;
  return {"SEPARATION",
          left + " and " + right + " could part by " + in_mm(separation_mm) +
              "; one that is not homed may be anywhere in its range.",
          "a separation of at most " + in_mm(pair.most_mm),
          "Run all home steps, which make room first; once homed, move the other slider inwards."};
}

Refusal parted(const Pair& pair, double separation_mm) {
  return {"SEPARATION",
          pair.left.axis().name + " and " + pair.right.axis().name + " would part by " +
              in_mm(separation_mm) + ".",
          "a separation of at most " + in_mm(pair.most_mm), "Choose targets that are closer together."};
}

using Positions = std::array<std::int32_t, ILK_SLOTS>;

std::vector<Pair> pairs_at(const Robot& robot, const Positions& positions) {
  return pairs_of(robot, [&positions](std::uint32_t slot) {
    ilk_axis_t state{};
    state.homed = 1;
    state.position_counts = positions[slot];
    return state;
  });
}

/** How a slider moves outwards from one row to the next. */
CubicSegment outwards(const Slider& slider, const Positions& positions, const TimedTrajectory& trajectory,
                      std::size_t row) {
  const auto& axes = trajectory.axes();
  const auto moved = std::find_if(axes.begin(), axes.end(), [&slider](const TrajectoryAxis& axis) {
    return axis.slot == slider.axis().slot;
  });
  if (moved == axes.end()) {
    return {{slider.outwards_mm(positions[slider.axis().slot]), 0.0, 0.0}, 0.0};
  }
  return slider.outwards(trajectory.piece(static_cast<std::size_t>(moved - axes.begin()), row));
}

/** The farthest that a pair parts from one row to the next. Two cubics of the same time add to one. */
double farthest_mm(const Pair& pair, const Positions& positions, const TimedTrajectory& trajectory,
                   std::size_t row) {
  const CubicSegment left = outwards(pair.left, positions, trajectory, row);
  const CubicSegment right = outwards(pair.right, positions, trajectory, row);
  const CubicSegment apart{left.start + right.start, left.jerk + right.jerk};
  PositionRange range{apart.start.position, apart.start.position};
  apart.widen(range, trajectory.step_s(row));
  return range.highest;
}

/** A step that only brings sliders together is allowed wherever they stand. */
tl::expected<void, Refusal> run(Pair& pair, const HomeStep& step) {
  const Sweep left = pair.left.sweep_of(step);
  const Sweep right = pair.right.sweep_of(step);
  const double separation_mm = std::max(pair.left.reach().outer_mm, left.after.outer_mm) +
                               std::max(pair.right.reach().outer_mm, right.after.outer_mm);
  if ((left.outwards || right.outwards) && separation_mm > pair.most_mm) {
    return tl::make_unexpected(too_far(pair, separation_mm));
  }
  pair.left.arrive(left.after);
  pair.right.arrive(right.after);
  return {};
}

}  // namespace

tl::expected<void, Refusal> check_separation(const Robot& robot, const ControlView& view,
                                             std::span<const HomeStep> steps) {
  const auto state_of = [&view](std::uint32_t slot) { return view.snapshot.state.axis[slot]; };
  for (Pair& pair : pairs_of(robot, state_of)) {
    for (const HomeStep& step : steps) {
      if (auto stays = run(pair, step); !stays) {
        return stays;
      }
    }
  }
  return {};
}

tl::expected<void, Refusal> check_separation(const Robot& robot, const Positions& positions) {
  for (const Pair& pair : pairs_at(robot, positions)) {
    const double separation_mm = pair.left.reach().outer_mm + pair.right.reach().outer_mm;
    if (separation_mm > pair.most_mm) {
      return tl::make_unexpected(parted(pair, separation_mm));
    }
  }
  return {};
}

tl::expected<void, Refusal> check_separation(const Robot& robot, const Positions& positions,
                                             const TimedTrajectory& trajectory) {
  for (const Pair& pair : pairs_at(robot, positions)) {
    for (std::size_t row = 0; row < trajectory.rows(); ++row) {
      const double separation_mm = farthest_mm(pair, positions, trajectory, row);
      if (separation_mm > pair.most_mm) {
        Refusal refusal = parted(pair, separation_mm);
        refusal.detail = "After row " + std::to_string(row + 1) + ": " + refusal.detail;
        return tl::make_unexpected(std::move(refusal));
      }
    }
  }
  return {};
}

}  // namespace interlock
