/**
 * @file
 * Plans anew, many times, from states of the planner's own plans, as a robot does whose target changes on the
 * way. Every plan must exist, begin in that state, end at rest at its target and keep the limits.
 *
 * INTERLOCK_REPLANS sets the number of plans, INTERLOCK_SEED where the chance begins:
 *
 *     INTERLOCK_REPLANS=1000000 build/release/bin/trajectory_tests --gtest_filter='Replan*'
 */
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <random>
#include <string>

#include "trajectory/synchronised_plan.hpp"
#include "trajectory/tick_planner.hpp"

namespace interlock {
namespace {

constexpr int usual_replans = 40'000;
constexpr int most_shown = 10; /**< failures */

int setting(const char* name, int usual) {
  const char* const value = std::getenv(name);
  return value == nullptr ? usual : std::atoi(value);
}

using Targets = std::vector<AxisTarget>;

/** Rates of the robots in models/robots, in counts: velocity, acceleration, jerk, counts per unit. */
struct ShippedRates {
  RateLimits counts;
  double counts_per_unit;
};
constexpr std::array shipped{
    ShippedRates{{600, 6000, 120'000}, 795.8},          ShippedRates{{600, 6000, 120'000}, 47.24},
    ShippedRates{{600, 6000, 120'000}, 40.0},           ShippedRates{{3333, 30'000, 600'000}, 265.27},
    ShippedRates{{20'000, 200'000, 4'000'000}, 2500.0}, ShippedRates{{20'000, 200'000, 4'000'000}, 1666.67}};

/** States and targets by chance, the awkward ones more often than chance has them. */
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : generator_(seed) {}

  std::size_t below(std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(generator_);
  }

  /** Of one axis to six, at rest. In counts, in the units of the axes, or with limits beyond all robots. */
  Targets robot() {
    const std::size_t kind = below(3);
    Targets targets(1 + below(6));
    for (AxisTarget& target : targets) {
      const ShippedRates& rates = shipped[below(shipped.size())];
      const double velocity = magnitude(1e-2, 1e4);
      const double acceleration = velocity * magnitude(0.5, 50.0);
      target.axis.limits = kind == 0   ? rates.counts
                           : kind == 1 ? in_units(rates)
                                       : RateLimits{velocity, acceleration, acceleration * magnitude(1, 100)};
      target.axis.limits.jerk = std::min(target.axis.limits.jerk, largest_rate);
      target.axis.limits.acceleration = std::min(target.axis.limits.acceleration, largest_rate);
      target.axis.now = {somewhere(target.axis), 0.0, 0.0};
      target.allowed = {-position_limit, position_limit};
      target.axis.name = "axis";
    }
    return targets;
  }

  /** A new target: anywhere, near, where the axis is, where it would come to rest, or the one that it has. */
  double target(const AxisTarget& target) {
    const MotionState& now = target.axis.now;
    switch (below(6)) {
      case 0:
        return now.position;
      case 1:
        return now.position + share() * magnitude(1e-15, 1e-6);
      case 2:
        return now.position + share() * magnitude(1e-6, 1.0);
      case 3:
        return rest_of(target.axis);
      case 4:
        return target.position;
      default:
        return somewhere(target.axis);
    }
  }

  /** A time within the plan: any, its start or end, or a boundary of an axis' pieces, an ulp or a little more
   * away from it. */
  double time_s(const SynchronisedPlan& plan) {
    switch (below(4)) {
      case 0:
        return 0.5 * (share() + 1) * plan.duration_s;
      case 1:
        return below(2) == 0 ? 0.0 : plan.duration_s;
      default:
        break;
    }
    const std::vector<double> times_s = plan.axes[below(plan.axes.size())].boundaries_s();
    const double boundary_s = times_s[below(times_s.size())];
    const std::array beside{boundary_s, std::nextafter(boundary_s, 0.0), std::nextafter(boundary_s, 1e9),
                            boundary_s - magnitude(1e-12, 1e-2), boundary_s + magnitude(1e-12, 1e-2)};
    return std::max(0.0, beside[below(beside.size())]);
  }

 private:
  static RateLimits in_units(const ShippedRates& rates) {
    return {rates.counts.velocity / rates.counts_per_unit, rates.counts.acceleration / rates.counts_per_unit,
            rates.counts.jerk / rates.counts_per_unit};
  }

  static double rest_of(const PlannedAxis& axis) {
    const auto stop = plan_stop(std::vector{axis});
    return stop ? stop->axes[0].at(stop->duration_s).position : axis.now.position;
  }

  /** Some seconds from zero at most. */
  double somewhere(const PlannedAxis& axis) {
    return std::clamp(share() * axis.limits.velocity * magnitude(0.01, 30.0), -0.9 * position_limit,
                      0.9 * position_limit);
  }

  double share() { return std::uniform_real_distribution(-1.0, 1.0)(generator_); }
  double magnitude(double lowest, double highest) {
    return std::exp(std::uniform_real_distribution(std::log(lowest), std::log(highest))(generator_));
  }

  std::mt19937_64 generator_;
};

/** Equal up to a rounding error of numbers of that size. */
bool near(double one, double other, double size, double tolerance = 1e-9) {
  return std::abs(one - other) <= tolerance * size + 1e-9;
}

bool equal_states(const MotionState& one, const MotionState& other, const RateLimits& limits) {
  return std::abs(one.position - other.position) <= rounding_s * limits.velocity &&
         std::abs(one.velocity - other.velocity) <= rounding_s * limits.acceleration &&
         std::abs(one.acceleration - other.acceleration) <= rounding_s * limits.jerk;
}

/** What is wrong with the motion of one axis; empty: nothing. */
std::string fault_of(const PiecewiseMotion& motion, const AxisTarget& target, double duration_s) {
  const auto& [now, limits] = std::pair(target.axis.now, target.axis.limits);
  if (!equal_states(motion.at(0.0), now, limits)) {
    return "does not begin where the axis is";
  }
  if (motion.at(duration_s) != MotionState{target.position, 0.0, 0.0}) {
    return "does not end at rest at its target";
  }
  const std::vector<double> times_s = motion.boundaries_s();
  for (std::size_t piece = 0; piece < times_s.size(); ++piece) {
    const double time_s = times_s[piece];
    const MotionState state = motion.at(time_s);
    const MotionState before = motion.at(std::nextafter(time_s, 0.0));
    const double size = std::abs(state.position) + std::abs(now.position) + limits.velocity * duration_s;
    if (std::abs(before.position - state.position) > 2 * rounding_s * limits.velocity + 1e-12 * size) {
      return "leaps in position";
    }
    if (!near(before.velocity, state.velocity, limits.velocity, 2e-8)) {
      return "leaps in velocity";
    }
    if (!near(before.acceleration, state.acceleration, limits.acceleration, 1e-8)) {
      return "leaps in acceleration";
    }
    if (std::abs(state.velocity) > limits.velocity * (1 + 1e-9) + 1e-9) {
      return "is too fast";
    }
    if (std::abs(state.acceleration) > limits.acceleration * (1 + 1e-9) + 1e-9) {
      return "accelerates too much";
    }
    if (piece + 1 < times_s.size()) {
      const double length_s = times_s[piece + 1] - time_s;
      const double rise =
          std::abs(motion.at(std::nextafter(times_s[piece + 1], 0.0)).acceleration - state.acceleration);
      if (rise > limits.jerk * length_s * (1 + 1e-9) + 1e-9 * (1 + limits.acceleration)) {
        return "jerks too much";
      }
    }
  }
  return "";
}

std::string fault_of(const tl::expected<SynchronisedPlan, TrajectoryError>& plan, const Targets& targets) {
  if (!plan) {
    return plan.error().message();
  }
  for (std::size_t place = 0; place < targets.size(); ++place) {
    if (std::string fault = fault_of(plan->axes[place], targets[place], plan->duration_s); !fault.empty()) {
      return fault;
    }
  }
  return "";
}

std::string fault_of(TickPlanner& planner, const Targets& targets, const SynchronisedPlan& plan) {
  std::vector<TickPlanner::AxisPath> paths;
  for (const AxisTarget& target : targets) {
    paths.push_back({target.axis.now, target.position, target.axis.limits});
  }
  if (!planner.plan(paths, 0.0)) {
    return "TickPlanner finds no plan";
  }
  if (!near(planner.duration_s(), plan.duration_s, plan.duration_s, 1e-6)) {
    return "TickPlanner takes another time";
  }
  for (std::size_t place = 0; place < targets.size(); ++place) {
    if (!equal_states(planner.at(0.0)[place], targets[place].axis.now, targets[place].axis.limits)) {
      return "TickPlanner does not begin where the axis is";
    }
    if (planner.at(planner.duration_s())[place] != MotionState{targets[place].position, 0.0, 0.0}) {
      return "TickPlanner does not end at rest at its target";
    }
  }
  return "";
}

std::string text_of(const Targets& targets) {
  std::string text;
  for (const AxisTarget& target : targets) {
    std::array<char, 400> line{};
    std::snprintf(line.data(), line.size(), "\n  {%.17g, %.17g, %.17g} to %.17g within {%.17g, %.17g, %.17g}",
                  target.axis.now.position, target.axis.now.velocity, target.axis.now.acceleration,
                  target.position, target.axis.limits.velocity, target.axis.limits.acceleration,
                  target.axis.limits.jerk);
    text += line.data();
  }
  return text;
}

TEST(Replan, EveryStateOfAPlanHasAPlanToAnyTarget) {
  const int replans = setting("INTERLOCK_REPLANS", usual_replans);
  Chance chance(static_cast<std::uint64_t>(setting("INTERLOCK_SEED", 1)));
  constexpr std::size_t chain = 10; /**< plans from one to the next */
  TickPlanner planner;
  Targets targets;
  std::optional<SynchronisedPlan> plan;
  std::map<std::string, int> faults;
  for (int trial = 0; trial < replans; ++trial) {
    if (!plan || trial % chain == 0) {
      targets = chance.robot();
    } else {
      const double time_s = chance.time_s(*plan);
      for (std::size_t place = 0; place < targets.size(); ++place) {
        targets[place].axis.now = plan->axes[place].at(time_s);
      }
    }
    for (AxisTarget& target : targets) {
      target.position = chance.target(target);
    }
    const auto next = plan_move(targets);
    std::string fault = fault_of(next, targets);
    if (fault.empty()) {
      fault = fault_of(planner, targets, *next);
    }
    if (!fault.empty() && ++faults[fault] <= most_shown) {
      ADD_FAILURE() << "plan " << trial << ": " << fault << text_of(targets);
    }
    plan = next ? std::optional(*next) : std::nullopt;
  }
  for (const auto& [fault, count] : faults) {
    ADD_FAILURE() << count << " of " << replans << ": " << fault;
  }
}

}  // namespace
}  // namespace interlock
