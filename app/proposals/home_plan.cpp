#include <algorithm>
#include <string>

#include "proposals/checks.hpp"

namespace interlock {
namespace {

void add(std::vector<std::uint32_t>& slots, std::uint32_t slot) {
  if (std::find(slots.begin(), slots.end(), slot) == slots.end()) {
    slots.push_back(slot);
  }
}

void add_axes(std::vector<std::uint32_t>& slots, const HomeStep& step) {
  for (const std::uint32_t slot : step.home) {
    add(slots, slot);
  }
  for (const AxisCounts& each : step.nudge) {
    add(slots, each.slot);
  }
  for (const AxisCounts& each : step.move) {
    add(slots, each.slot);
  }
}

std::string step_names(const Robot& robot) {
  std::string names;
  for (const HomeStep& step : robot.home_steps) {
    names += (names.empty() ? "" : ", ") + step.name;
  }
  return names;
}

HomeTask plan_of_steps(const Robot& robot, std::size_t first, std::size_t count) {
  HomeTask plan{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count), {}};
  for (std::size_t i = first; i < first + count; ++i) {
    add_axes(plan.slots, robot.home_steps[i]);
  }
  return plan;
}

/** What is homed now, or will be once the steps before have run. */
tl::expected<void, Refusal> check_moves(const Robot& robot, const ControlView& view, const HomeTask& plan) {
  std::vector<std::uint32_t> homed;
  for (std::uint32_t i = 0; i < plan.step_count; ++i) {
    const HomeStep& step = robot.home_steps[plan.first_step + i];
    for (const AxisCounts& each : step.move) {
      const bool homed_before = std::find(homed.begin(), homed.end(), each.slot) != homed.end();
      if (!homed_before && view.snapshot.state.axis[each.slot].homed == 0) {
        const std::string name = robot.at_slot(each.slot)->name;
        return tl::make_unexpected(Refusal{
            "NOT_HOMED", "Step " + step.name + " moves " + name + " to a position, and it is not homed.",
            "a homed axis", "Home " + name + " first, or run all home steps."});
      }
    }
    homed.insert(homed.end(), step.home.begin(), step.home.end());
  }
  return {};
}

std::vector<HomeStep> steps_of(const Robot& robot, const HomeTask& plan) {
  if (plan.step_count == 0) {
    HomeStep alone;
    alone.home = plan.slots;
    return {alone};
  }
  const auto first = robot.home_steps.begin() + plan.first_step;
  return {first, first + plan.step_count};
}

bool goes_to_switch(const Robot& robot, const HomeTask& plan, std::uint32_t slot) {
  if (plan.step_count == 0) {
    return true;
  }
  const auto first = robot.home_steps.begin() + plan.first_step;
  return std::any_of(first, first + plan.step_count, [slot](const HomeStep& step) {
    return std::find(step.home.begin(), step.home.end(), slot) != step.home.end();
  });
}

tl::expected<void, Refusal> check_able(const Robot& robot, const ControlView& view, const HomeTask& plan) {
  for (const std::uint32_t slot : plan.slots) {
    if (auto able = check_axis(*robot.at_slot(slot), view); !able) {
      return able;
    }
  }
  return {};
}

tl::expected<void, Refusal> check_switches(const Robot& robot, const HomeTask& plan) {
  for (const std::uint32_t slot : plan.slots) {
    const Axis& axis = *robot.at_slot(slot);
    if (goes_to_switch(robot, plan, slot) && axis.limit == ILK_LIMIT_NONE) {
      return tl::make_unexpected(
          verdict_refusal(ILK_VERDICT_NO_SWITCH, axis.name, "an axis with a limit switch"));
    }
  }
  return {};
}

}  // namespace

HomeTask home_axis(std::uint32_t slot) { return {0, 0, {slot}}; }

tl::expected<HomeTask, Refusal> home_step(const Robot& robot, const std::string& name) {
  const auto found = std::find_if(robot.home_steps.begin(), robot.home_steps.end(),
                                  [&](const HomeStep& step) { return step.name == name; });
  if (found == robot.home_steps.end()) {
    return tl::make_unexpected(Refusal{"NOT_FOUND", robot.title + " has no home step \"" + name + "\".",
                                       "one of: " + step_names(robot), "Choose a home step of the robot."});
  }
  return plan_of_steps(robot, static_cast<std::size_t>(found - robot.home_steps.begin()), 1);
}

tl::expected<HomeTask, Refusal> home_all(const Robot& robot) {
  if (robot.home_steps.empty()) {
    return tl::make_unexpected(Refusal{"NOT_FOUND", robot.title + " has no home steps.",
                                       "a robot file with [[home_step]]", "Home each axis by itself."});
  }
  return plan_of_steps(robot, 0, robot.home_steps.size());
}

void check_home(const Robot& robot, const ilk_config_t& config, const ControlView& view, const HomeTask& plan,
                CheckList& checks) {
  check_system(config, view, checks);
  checks.make(CheckName::axes, [&] { return check_able(robot, view, plan); });
  checks.make(CheckName::switches, [&] { return check_switches(robot, plan); });
  checks.make(CheckName::home_order, [&] { return check_moves(robot, view, plan); });
  checks.make(CheckName::separation, [&] {
    const std::vector<HomeStep> steps = steps_of(robot, plan);
    return check_separation(robot, view, steps);
  });
}

}  // namespace interlock
