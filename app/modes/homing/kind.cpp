#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "modes/homing/mode.hpp"
#include "proposals/checks.hpp"
#include "proposals/motion_kind.hpp"

namespace interlock {
namespace {

using nlohmann::json;

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

/**
 * Judges homing against the newest view: CONFIG_MISMATCH, MODE, then for each axis FAULTED and DISABLED,
 * then NO_SWITCH, then NOT_HOMED where a step goes to a position and no earlier step homes the axis, and last
 * SEPARATION.
 */
static void check_home(const Robot& robot, const ilk_config_t& config, const ControlView& view,
                       const HomeTask& plan, CheckList& checks) {
  check_system(config, view, checks);
  checks.make(CheckName::axes, [&] { return check_able(robot, view, plan); });
  checks.make(CheckName::switches, [&] { return check_switches(robot, plan); });
  checks.make(CheckName::home_order, [&] { return check_moves(robot, view, plan); });
  checks.make(CheckName::separation, [&] {
    const std::vector<HomeStep> steps = steps_of(robot, plan);
    return check_separation(robot, states_of(view), steps);
  });
}

namespace {

std::vector<std::uint32_t> slots_of(const std::vector<AxisCounts>& axes) {
  std::vector<std::uint32_t> slots;
  for (const AxisCounts& each : axes) {
    slots.push_back(each.slot);
  }
  return slots;
}

/** "homes yaw and pitch; step 2 of 3" */
std::string work_words(const Robot& robot, const Proposal& proposal, std::uint32_t step) {
  const HomeTask& homing = *proposal.work<HomeTask>();
  if (homing.step_count == 0 || step >= robot.home_steps.size()) {
    return "homes " + listed(robot, proposal.slots);
  }
  const HomeStep& now = robot.home_steps[step];
  std::string text = "homes " + listed(robot, now.home);
  if (!now.nudge.empty()) {
    text = "moves " + listed(robot, slots_of(now.nudge)) + " out of the way";
  } else if (!now.move.empty()) {
    text = "moves " + listed(robot, slots_of(now.move)) + " into position";
  }
  if (homing.step_count > 1) {
    text +=
        "; step " + std::to_string(step - homing.first_step + 1) + " of " + std::to_string(homing.step_count);
  }
  return text;
}

/** "Homed yaw and pitch." Axes that were only moved are not homed by it. */
std::string done_words(const Robot& robot, const Proposal& proposal) {
  const HomeTask& homing = *proposal.work<HomeTask>();
  std::vector<std::uint32_t> homed = homing.step_count == 0 ? proposal.slots : std::vector<std::uint32_t>();
  for (std::uint32_t i = 0; i < homing.step_count; ++i) {
    const HomeStep& step = robot.home_steps[homing.first_step + i];
    homed.insert(homed.end(), step.home.begin(), step.home.end());
  }
  return homed.empty() ? "Moved " + listed(robot, proposal.slots) + "; nothing was homed by it."
                       : "Homed " + listed(robot, homed) + ".";
}

/** "12.4 mm left" */
std::string left_words(const Robot& robot, const TaskStatus& status) {
  const Axis* axis = robot.at_slot(status.slot);
  if (axis == nullptr || status.left_counts == 0) {
    return "";
  }
  const bool degrees = axis->unit == Unit::rad;
  const double radians_to_degrees = 57.29577951308232;
  const double left = std::abs(axis->to_unit(status.left_counts)) * (degrees ? radians_to_degrees : 1.0);
  std::array<char, 48> number{};
  std::snprintf(number.data(), number.size(), "%.1f %s left", left, degrees ? "degrees" : "mm");
  return number.data();
}

class HomeKind final : public MotionKind {
 public:
  [[nodiscard]] std::string_view name() const override { return "home"; }
  [[nodiscard]] const std::type_info& tasks() const override { return typeid(HomeTask); }
  [[nodiscard]] std::unique_ptr<Mode> make_mode(const RobotPlan& plan) const override {
    return std::make_unique<HomeMode>(plan);
  }

  [[nodiscard]] std::vector<std::uint32_t> slots(const Robot& /*robot*/, const Work& work) const override {
    return work.as<HomeTask>().slots;
  }

  void check(const Scene& scene, Proposal& proposal, CheckList& checks) const override {
    check_home(scene.robot, scene.config, scene.view, *proposal.work<HomeTask>(), checks);
  }

  void begin(const Robot& robot, Proposal& proposal) const override {
    show_step(robot, first_step(proposal.task->work), proposal);
  }

  void follow(const Scene& scene, const TaskStatus& status, Proposal& proposal) const override {
    show_step(scene.robot, status.step, proposal);
  }

  [[nodiscard]] std::uint32_t first_step(const Work& work) const override {
    return work.as<HomeTask>().first_step;
  }

  [[nodiscard]] json asked(const Robot& robot, const Work& work) const override {
    const HomeTask& homing = work.as<HomeTask>();
    if (homing.step_count == 0) {
      return {{"axis", robot.at_slot(homing.slots.front())->name}};
    }
    return homing.step_count == 1 ? json{{"step", robot.home_steps[homing.first_step].name}} : json::object();
  }

  void add_fields(const Proposal& proposal, json& fields) const override {
    if (!proposal.step.empty()) {
      fields["step"] = proposal.step;
    }
  }

  [[nodiscard]] TaskWords words(const Robot& robot, const Proposal& proposal, const TaskStatus& status,
                                const BiopsyFindings& /*found*/) const override {
    const std::string work = work_words(robot, proposal, status.step);
    const bool again = status.reason == TaskReason::press_again;
    const std::string left = left_words(robot, status);
    return {"; then " + work, capital(work),
            (again ? "Release the pedal and press it again to go on" : paused_words("")) +
                (left.empty() ? "" : ": " + left),
            status.phase == TaskPhase::done ? done_words(robot, proposal) : "", title_of(robot, status.slot)};
  }

  [[nodiscard]] Profile profile(const Robot& /*robot*/, const ilk_config_t& /*config*/,
                                const Proposal& /*proposal*/) const override {
    return no_profile("Homing goes to the limit switches; where these are is found on the way.");
  }

 private:
  static void show_step(const Robot& robot, std::uint32_t step, Proposal& proposal) {
    const bool is_step = proposal.work<HomeTask>()->step_count != 0 && step < robot.home_steps.size();
    proposal.step = is_step ? robot.home_steps[step].name : "";
  }
};

}  // namespace

const MotionKind& homing_kind();
const MotionKind& homing_kind() {
  static const HomeKind kind;
  return kind;
}

}  // namespace interlock
