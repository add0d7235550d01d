#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <vector>

#include "control/frequency_map.hpp"
#include "proposals/proposal_json.hpp"
#include "robot/catalog.hpp"

namespace interlock {
namespace {

std::string words(catalog::Family family, std::uint32_t code) {
  const catalog::Entry& entry = catalog::entry(family, code);
  return catalog::name(family, code) + ": " + std::string(entry.meaning) + " " + std::string(entry.next_step);
}

/** Why a task ended. `axis` as it reads within a sentence; the first letter is left small. */
std::string end_words(const std::string& axis, const TaskStatus& status) {
  switch (status.reason) {
    case TaskReason::none:
    case TaskReason::arrived:
    case TaskReason::pedal_released:
    case TaskReason::press_again:
    case TaskReason::swept:
    case TaskReason::steering_failed:
      return "";
    case TaskReason::force_stale:
      return "The force sensor told nothing new for too long, so the needle was stopped. Look at its card.";
    case TaskReason::kernel_refused:
      return "The kernel refused: " + words(catalog::Family::verdict, status.code);
    case TaskReason::stopped:
      return "STOP.";
    case TaskReason::let_go:
      return "It was let go, or its hold was not renewed within " + std::to_string(jog_timeout.count()) +
             " ms.";
    case TaskReason::nobody_served:
      return "The app stopped answering people, so motion ended. Look at what holds up the machine; propose "
             "it again.";
    case TaskReason::approved_late:
      return "The approval reached the control thread more than " + std::to_string(approval_timeout.count()) +
             " ms late; look at the robot and propose it again.";
    case TaskReason::cancelled:
      return "Ended by its author.";
    case TaskReason::locked:
      return "The kernel locked. " + words(catalog::Family::cause, status.code);
    case TaskReason::axis_disabled:
      return axis + " was disabled.";
    case TaskReason::axis_homing:
      return "Homing took over the axis.";
    case TaskReason::axis_faulted:
      return axis + " faulted. " + words(catalog::Family::fault, status.code);
    case TaskReason::blocked:
      return "A limit held " + axis + " back. " + words(catalog::Family::gate, status.code);
    case TaskReason::link_lost:
      return "The link to the kernel was lost.";
    case TaskReason::waited_too_long:
      return "The pedal was not held for 60 s; propose it again.";
    case TaskReason::not_homed:
      return axis + " is not homed, so it cannot go to a position. Home it first.";
    case TaskReason::verdict_lost:
      return "The kernel's answer about " + axis + " was lost; propose it again.";
    case TaskReason::authority_changed:
      return "Motion authority changed; propose it again.";
    case TaskReason::position_declared:
      return axis + " was given another position by Set Home or Restore; propose it again.";
    case TaskReason::superseded:
      return "Another motion took over the axes.";
    case TaskReason::off_path:
      return axis + " strayed too far from its path, so every axis was stopped. Look for what holds it back.";
    case TaskReason::goal_late:
      return axis + " did not come to rest at its goal within 5 s. Look for what holds it back.";
    case TaskReason::no_path:
      return "No motion within the rates of the axes leads there from where they are; propose it again.";
  }
  return "";
}

std::string capital(std::string text) {
  if (!text.empty()) {
    text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  }
  return text;
}

/** The title of the axis as it reads within a sentence. */
std::string title_of(const Robot& robot, std::uint32_t slot) {
  const Axis* axis = robot.at_slot(slot);
  std::string title = axis == nullptr ? "slot " + std::to_string(slot) : axis->title;
  const bool abbreviation = title.size() > 1 && std::isupper(static_cast<unsigned char>(title[1])) != 0;
  if (!title.empty() && !abbreviation) {
    title[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(title[0])));
  }
  return title;
}

std::string listed(const Robot& robot, const std::vector<std::uint32_t>& slots) {
  std::string text;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const char* before = i == 0 ? "" : i + 1 == slots.size() ? " and " : ", ";
    text += before + title_of(robot, slots[i]);
  }
  return text;
}

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

/** ", 52000.0 Hz, frequency 3 of 12" */
std::string frequency_words(const FrequencySteps& steps, std::uint32_t step) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), ", %.1f Hz, frequency %u of %u",
                frequency_map::hz_of(steps.word(step)), step + 1, steps.count);
  return text.data();
}

/** What differs from kind to kind, each a sentence, or what follows in one. */
struct TaskWords {
  std::string waiting;
  std::string executing;
  std::string paused;
  std::string done;
  std::string axis; /**< that the reason is about */
};

std::string paused_words(const std::string& part) {
  return "Motion ended" + part + "; press and hold the pedal within 60 s to go on";
}

TaskWords words_of(const Robot& robot, const Proposal& proposal, const TaskStatus& status,
                   const BiopsyFindings& found) {
  const std::string axis = title_of(robot, status.slot);
  const std::string while_held = listed(robot, proposal.slots) + " while the pedal is held";
  switch (proposal.task->kind()) {
    case TaskKind::move:
      return {"", "Moves while the pedal is held", paused_words(""),
              "At rest within the deadband of the target.", "the axis"};
    case TaskKind::home: {
      const std::string work = work_words(robot, proposal, status.step);
      const bool again = status.reason == TaskReason::press_again;
      const std::string left = left_words(robot, status);
      return {"; then " + work, capital(work),
              (again ? "Release the pedal and press it again to go on" : paused_words("")) +
                  (left.empty() ? "" : ": " + left),
              status.phase == TaskPhase::done ? done_words(robot, proposal) : "", axis};
    }
    case TaskKind::path: {
      const std::size_t legs = proposal.work<PathTask>()->program->legs.size();
      const std::string part =
          legs > 1 ? ", part " + std::to_string(status.step + 1) + " of " + std::to_string(legs) : "";
      return {"", "Moves " + while_held + part, paused_words(part),
              "All axes rest within the deadband of their goals.", axis};
    }
    case TaskKind::sweep: {
      const FrequencySteps& steps = proposal.work<SweepTask>()->steps;
      const std::string part = frequency_words(steps, std::min(status.step, steps.count - 1));
      return {"", "Turns " + while_held + part, paused_words(part),
              "Each of " + std::to_string(steps.count) + " frequencies was held for its time.", axis};
    }
    case TaskKind::biopsy: {
      const bool any = found.task == status.task && found.membranes != 0;
      const std::string passed = any ? "; membranes passed: " + std::to_string(found.membranes) : "";
      return {"; then the hand on the force sensor pushes the needle",
              "Follows the hand while the pedal is held" + passed, paused_words(passed),
              "The tip is at the depth of its target" + passed + ".", axis};
    }
  }
  return {};
}

}  // namespace

ProposalState state_of(TaskPhase phase) noexcept {
  switch (phase) {
    case TaskPhase::none:
    case TaskPhase::waiting:
      return ProposalState::approved;
    case TaskPhase::executing:
      return ProposalState::executing;
    case TaskPhase::paused:
      return ProposalState::paused;
    case TaskPhase::done:
      return ProposalState::done;
    case TaskPhase::refused:
      return ProposalState::refused;
    case TaskPhase::aborted:
      return ProposalState::aborted;
    case TaskPhase::expired:
      return ProposalState::expired;
  }
  return ProposalState::aborted;
}

std::string detail_of(const Robot& robot, const Proposal& proposal, const TaskStatus& status,
                      const BiopsyFindings& found) {
  const TaskWords words = words_of(robot, proposal, status, found);
  switch (status.phase) {
    case TaskPhase::none:
    case TaskPhase::waiting:
      return "Waits for the pedal" + words.waiting + ".";
    case TaskPhase::executing:
      return words.executing + ".";
    case TaskPhase::paused:
      return words.paused + ".";
    case TaskPhase::done:
      return words.done;
    default:
      break;
  }
  if (status.reason == TaskReason::steering_failed) {
    return "Steering cannot work with " + std::string(found.quantity) + " (" +
           std::string(code_name(static_cast<KinematicsError::Code>(status.code))) +
           "), so the needle was stopped. Withdraw it, look at target and images, and propose it again.";
  }
  return capital(end_words(words.axis, status));
}

std::optional<std::string> verdict_of(const TaskStatus& status) {
  switch (status.reason) {
    case TaskReason::kernel_refused:
      return catalog::name(catalog::Family::verdict, status.code);
    case TaskReason::axis_faulted:
      return catalog::name(catalog::Family::verdict, ILK_VERDICT_FAULTED);
    case TaskReason::axis_disabled:
      return catalog::name(catalog::Family::verdict, ILK_VERDICT_DISABLED);
    case TaskReason::axis_homing:
      return catalog::name(catalog::Family::verdict, ILK_VERDICT_BUSY);
    case TaskReason::locked:
      return catalog::name(catalog::Family::verdict, ILK_VERDICT_MODE);
    default:
      return std::nullopt;
  }
}

}  // namespace interlock
