#include "trajectory/tick_planner.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "trajectory/ruckig_calculate.hpp"

namespace interlock {
namespace {

using Axes = std::array<double, TickPlanner::capacity>;

bool within(double value, double lowest, double highest) noexcept {
  return value >= lowest && value <= highest;  // false for NaN
}

bool is_rate(double value) noexcept { return within(value, smallest_rate, largest_rate); }

bool makes_sense(const TickPlanner::AxisPath& axis) noexcept {
  return within(axis.now.position, -position_limit, position_limit) &&
         within(axis.target, -position_limit, position_limit) &&
         within(axis.now.velocity, -largest_rate, largest_rate) &&
         within(axis.now.acceleration, -largest_rate, largest_rate) && is_rate(axis.limits.velocity) &&
         is_rate(axis.limits.acceleration) && is_rate(axis.limits.jerk);
}

}  // namespace

struct TickPlanner::Workshop {
  ruckig::Ruckig<capacity> planner;
  ruckig::InputParameter<capacity> input;
  ruckig::Trajectory<capacity> plan;
  Axes positions{};
  Axes velocities{};
  Axes accelerations{};
  std::array<MotionState, capacity> states{};
  std::array<RuckigUnit, capacity> units{};
  std::array<double, capacity> targets{};
};

TickPlanner::TickPlanner() : workshop_(std::make_unique<Workshop>()) {
  workshop_->input.synchronization = ruckig::Synchronization::Phase;
}

TickPlanner::~TickPlanner() = default;
TickPlanner::TickPlanner(TickPlanner&&) noexcept = default;
TickPlanner& TickPlanner::operator=(TickPlanner&&) noexcept = default;

bool TickPlanner::plan(std::span<const AxisPath> axes, double minimum_duration_s) noexcept {
  Workshop& shop = *workshop_;
  axes_ = std::min(axes.size(), capacity);
  duration_s_ = 0.0;
  planned_ = false;
  bool sensible = !axes.empty() && axes.size() <= capacity && within(minimum_duration_s, 0.0, longest_plan_s);
  for (std::size_t place = 0; place < capacity; ++place) {
    const bool used = place < axes_;
    shop.input.enabled[place] = used;
    if (!used) {
      continue;
    }
    const AxisPath& axis = axes[place];
    sensible = sensible && makes_sense(axis);
    shop.states[place] = {axis.now.position, 0.0, 0.0};
    shop.targets[place] = axis.target;
    shop.units[place] = put_axis(shop.input, place, axis.now, axis.target, axis.limits);
  }
  if (!sensible) {
    return false;
  }
  shop.input.minimum_duration = minimum_duration_s;
  const ruckig::Result result = calculate(shop.planner, shop.input, shop.plan);
  if (result != ruckig::Working && result != ruckig::Finished) {
    return false;
  }
  duration_s_ = shop.plan.get_duration();
  planned_ = true;
  return true;
}

std::span<const MotionState> TickPlanner::at(double time_s) noexcept {
  Workshop& shop = *workshop_;
  const std::span<MotionState> states(shop.states.data(), axes_);
  if (!planned_) {
    return states;
  }
  if (time_s >= duration_s_) {
    for (std::size_t place = 0; place < axes_; ++place) {
      states[place] = {shop.targets[place], 0.0, 0.0};
    }
    return states;
  }
  shop.plan.at_time(time_s > 0.0 ? time_s : 0.0, shop.positions, shop.velocities, shop.accelerations);
  for (std::size_t place = 0; place < axes_; ++place) {
    states[place] = shop.units[place].from_ruckig(shop.positions[place], shop.velocities[place],
                                                  shop.accelerations[place]);
  }
  return states;
}

}  // namespace interlock
