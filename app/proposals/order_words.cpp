#include "proposals/order_words.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <vector>

#include "control/frequency_map.hpp"
#include "robot/catalog.hpp"

namespace interlock {
namespace {

std::string words(catalog::Family family, std::uint32_t code) {
  const catalog::Entry& entry = catalog::entry(family, code);
  return catalog::name(family, code) + ": " + std::string(entry.meaning) + " " + std::string(entry.next_step);
}

/** Why an order ended. `axis` as it reads within a sentence; the first letter is left small. */
std::string end_words(const std::string& axis, const OrderStatus& status) {
  switch (status.reason) {
    case OrderReason::none:
    case OrderReason::arrived:
    case OrderReason::pedal_released:
    case OrderReason::press_again:
    case OrderReason::swept:
    case OrderReason::steering_failed:
      return "";
    case OrderReason::force_stale:
      return "The force sensor told nothing new for too long, so the needle was stopped. Look at its card.";
    case OrderReason::kernel_refused:
      return "The kernel refused: " + words(catalog::Family::verdict, status.code);
    case OrderReason::stopped:
      return "STOP.";
    case OrderReason::let_go:
      return "It was let go, or its hold was not renewed within " + std::to_string(jog_patience.count()) +
             " ms.";
    case OrderReason::nobody_served:
      return "The app stopped answering people, so motion ended. Look at what holds up the machine; propose "
             "it again.";
    case OrderReason::cancelled:
      return "Ended by its author.";
    case OrderReason::locked:
      return "The kernel locked. " + words(catalog::Family::cause, status.code);
    case OrderReason::axis_disabled:
      return axis + " was disabled.";
    case OrderReason::axis_homing:
      return "Homing took over the axis.";
    case OrderReason::axis_faulted:
      return axis + " faulted. " + words(catalog::Family::fault, status.code);
    case OrderReason::blocked:
      return "A limit held " + axis + " back. " + words(catalog::Family::gate, status.code);
    case OrderReason::link_lost:
      return "The link to the kernel was lost.";
    case OrderReason::waited_too_long:
      return "The pedal was not held for 60 s; propose it again.";
    case OrderReason::not_homed:
      return axis + " is not homed, so it cannot go to a position. Home it first.";
    case OrderReason::verdict_lost:
      return "The kernel's answer about " + axis + " was lost; propose it again.";
    case OrderReason::authority_changed:
      return "Motion authority changed; propose it again.";
    case OrderReason::position_declared:
      return axis + " was given another position by Set Home or Restore; propose it again.";
    case OrderReason::superseded:
      return "Another motion took over the axes.";
    case OrderReason::off_path:
      return axis + " strayed too far from its path, so every axis was stopped. Look for what holds it back.";
    case OrderReason::goal_late:
      return axis + " did not come to rest at its goal within 5 s. Look for what holds it back.";
    case OrderReason::no_path:
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
  if (proposal.step_count == 0 || step >= robot.home_steps.size()) {
    return "homes " + listed(robot, proposal.slots);
  }
  const HomeStep& now = robot.home_steps[step];
  std::string text = "homes " + listed(robot, now.home);
  if (!now.nudge.empty()) {
    text = "moves " + listed(robot, slots_of(now.nudge)) + " out of the way";
  } else if (!now.move.empty()) {
    text = "moves " + listed(robot, slots_of(now.move)) + " into position";
  }
  if (proposal.step_count > 1) {
    text += "; step " + std::to_string(step - proposal.first_step + 1) + " of " +
            std::to_string(proposal.step_count);
  }
  return text;
}

/** "Homed yaw and pitch." Axes that were only moved are not homed by it. */
std::string done_words(const Robot& robot, const Proposal& proposal) {
  std::vector<std::uint32_t> homed = proposal.step_count == 0 ? proposal.slots : std::vector<std::uint32_t>();
  for (std::uint32_t i = 0; i < proposal.step_count; ++i) {
    const HomeStep& step = robot.home_steps[proposal.first_step + i];
    homed.insert(homed.end(), step.home.begin(), step.home.end());
  }
  return homed.empty() ? "Moved " + listed(robot, proposal.slots) + "; nothing was homed by it."
                       : "Homed " + listed(robot, homed) + ".";
}

/** "12.4 mm left" */
std::string left_words(const Robot& robot, const HomeStatus& status) {
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

std::string paused_words(const Robot& robot, const HomeStatus& status) {
  const bool again = status.order.reason == OrderReason::press_again;
  const std::string left = left_words(robot, status);
  return std::string(again ? "Release the pedal and press it again to go on"
                           : "Motion ended; press and hold the pedal within 60 s to go on") +
         (left.empty() ? "." : ": " + left + ".");
}

}  // namespace

ProposalState state_of(OrderPhase phase) noexcept {
  switch (phase) {
    case OrderPhase::none:
    case OrderPhase::waiting:
      return ProposalState::approved;
    case OrderPhase::executing:
      return ProposalState::executing;
    case OrderPhase::paused:
      return ProposalState::paused;
    case OrderPhase::done:
      return ProposalState::done;
    case OrderPhase::refused:
      return ProposalState::refused;
    case OrderPhase::aborted:
      return ProposalState::aborted;
    case OrderPhase::expired:
      return ProposalState::expired;
  }
  return ProposalState::aborted;
}

std::string detail_of(const OrderStatus& status) {
  switch (status.phase) {
    case OrderPhase::none:
    case OrderPhase::waiting:
      return "Waits for the pedal.";
    case OrderPhase::executing:
      return "Moves while the pedal is held.";
    case OrderPhase::paused:
      return "Motion ended; press and hold the pedal within 60 s to go on.";
    case OrderPhase::done:
      return "At rest within the deadband of the target.";
    default:
      return capital(end_words("the axis", status));
  }
}

std::string detail_of(const Robot& robot, const Proposal& proposal, const HomeStatus& status) {
  const std::string work = work_words(robot, proposal, status.step);
  const std::string axis = title_of(robot, status.slot);
  switch (status.order.phase) {
    case OrderPhase::none:
    case OrderPhase::waiting:
      return "Waits for the pedal; then " + work + ".";
    case OrderPhase::executing:
      return capital(work) + ".";
    case OrderPhase::paused:
      return paused_words(robot, status);
    case OrderPhase::done:
      return done_words(robot, proposal);
    default:
      return capital(end_words(axis, status.order));
  }
}

std::string detail_of(const Robot& robot, const Proposal& proposal, const PathStatus& status) {
  const std::size_t legs = proposal.path.program->legs.size();
  const std::string part =
      legs > 1 ? ", part " + std::to_string(status.leg + 1) + " of " + std::to_string(legs) : "";
  switch (status.order.phase) {
    case OrderPhase::none:
    case OrderPhase::waiting:
      return "Waits for the pedal.";
    case OrderPhase::executing:
      return "Moves " + listed(robot, proposal.slots) + " while the pedal is held" + part + ".";
    case OrderPhase::paused:
      return "Motion ended" + part + "; press and hold the pedal within 60 s to go on.";
    case OrderPhase::done:
      return "All axes rest within the deadband of their goals.";
    default:
      return capital(end_words(title_of(robot, status.slot), status.order));
  }
}

std::string detail_of(const Robot& robot, const Proposal& proposal, const SweepStatus& status) {
  const FrequencySteps& steps = proposal.sweep.steps;
  const std::string part = frequency_words(steps, std::min(status.step, steps.count - 1));
  switch (status.order.phase) {
    case OrderPhase::none:
    case OrderPhase::waiting:
      return "Waits for the pedal.";
    case OrderPhase::executing:
      return "Turns " + listed(robot, proposal.slots) + " while the pedal is held" + part + ".";
    case OrderPhase::paused:
      return "Motion ended" + part + "; press and hold the pedal within 60 s to go on.";
    case OrderPhase::done:
      return "Each of " + std::to_string(steps.count) + " frequencies was held for its time.";
    default:
      return capital(end_words(title_of(robot, proposal.sweep.slot), status.order));
  }
}

std::string detail_of(const Robot& robot, const BiopsyStatus& status) {
  const std::string found =
      status.membranes == 0 ? "" : "; membranes passed: " + std::to_string(status.membranes);
  switch (status.order.phase) {
    case OrderPhase::none:
    case OrderPhase::waiting:
      return "Waits for the pedal; then the hand on the force sensor pushes the needle.";
    case OrderPhase::executing:
      return "Follows the hand while the pedal is held" + found + ".";
    case OrderPhase::paused:
      return "Motion ended" + found + "; press and hold the pedal within 60 s to go on.";
    case OrderPhase::done:
      return "The tip is at the depth of its target" + found + ".";
    default:
      break;
  }
  if (status.order.reason == OrderReason::steering_failed) {
    return "Steering cannot work with " + std::string(status.quantity) + " (" +
           std::string(code_name(static_cast<KinematicsError::Code>(status.order.code))) +
           "), so the needle was stopped. Withdraw it, look at target and images, and propose it again.";
  }
  return capital(end_words(title_of(robot, status.slot), status.order));
}

std::optional<std::string> verdict_of(const OrderStatus& status) {
  switch (status.reason) {
    case OrderReason::kernel_refused:
      return catalog::name(catalog::Family::verdict, status.code);
    case OrderReason::axis_faulted:
      return catalog::name(catalog::Family::verdict, ILK_VERDICT_FAULTED);
    case OrderReason::axis_disabled:
      return catalog::name(catalog::Family::verdict, ILK_VERDICT_DISABLED);
    case OrderReason::axis_homing:
      return catalog::name(catalog::Family::verdict, ILK_VERDICT_BUSY);
    case OrderReason::locked:
      return catalog::name(catalog::Family::verdict, ILK_VERDICT_MODE);
    default:
      return std::nullopt;
  }
}

}  // namespace interlock
