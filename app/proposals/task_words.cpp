#include <array>
#include <cctype>
#include <vector>

#include "proposals/motion_kind.hpp"
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
    case TaskReason::unconfirmed:
    case TaskReason::breathing:
    case TaskReason::gate_turned_off:
    case TaskReason::scanning:
    case TaskReason::swept:
    case TaskReason::measured:
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
      return "It was cancelled.";
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
      return "It waited too long: 60 s for the pedal or a new press of it, or 10 minutes for its "
             "confirmation; propose it again.";
    case TaskReason::not_homed:
      return axis + " is not homed, so it cannot go to a position. Home it first.";
    case TaskReason::verdict_lost:
      return "The kernel's answer about " + axis + " was lost; propose it again.";
    case TaskReason::control_changed:
      return "Control changed hands; propose it again.";
    case TaskReason::position_declared:
      return axis + " was given another position by Set Home or Restore; propose it again.";
    case TaskReason::superseded:
      return "Another motion took over the axes.";
    case TaskReason::off_path:
      return axis +
             " strayed too far from its path, or held it up for 5 s, so every axis was stopped. "
             "Look for what holds it back.";
    case TaskReason::goal_late:
      return axis + " did not come to rest at its goal within 5 s. Look for what holds it back.";
    case TaskReason::moved_away:
      return axis +
             " was moved, and what this motion does was right only while it stood where it was. Line the "
             "robot up again, then propose it again.";
    case TaskReason::linkage_strained:
      return axis +
             " and the slider that is linked to it came to a separation that their linkage does not allow, "
             "so "
             "motion ended. Look where both stand; then propose motion that brings them back.";
    case TaskReason::axis_stands:
      return stands_words(axis) +
             ". Look for what holds it back, and at docs/tuning.md; then propose it again.";
    case TaskReason::no_path:
      return "No motion within the rates of the axes leads there from where they are; propose it again.";
  }
  return "";
}

}  // namespace

std::string capital(std::string text) {
  if (!text.empty()) {
    text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  }
  return text;
}

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

std::string paused_words(const std::string& part) {
  return "Motion ended" + part + "; press and hold the pedal within 60 s to go on";
}

const MotionKind& kind_of(const Work& work) {
  const auto kinds = motion_kinds();
  // Work is made of the tasks of some kind; one of none would find no mode either.
  const auto found =
      std::ranges::find_if(kinds, [&work](const MotionKind* each) { return each->tasks() == work.type(); });
  if (found == kinds.end()) {
    throw std::logic_error(std::string("no kind of motion takes a task of the type ") + work.type().name());
  }
  return **found;
}

Modes make_modes(const RobotPlan& plan) {
  Modes modes;
  for (const MotionKind* kind : motion_kinds()) {
    modes.push_back(kind->make_mode(plan));
  }
  return modes;
}

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
  if (is_open(status.phase) && status.reason == TaskReason::breathing) {
    return "Waits under the held pedal for the breathing gate: goes on by itself when that opens, and at the "
           "next press when it is turned off.";
  }
  if (is_open(status.phase) && status.reason == TaskReason::gate_turned_off) {
    return "The breathing gate was turned off while this waited for it: release the pedal and press it to go "
           "on.";
  }
  if (is_open(status.phase) && status.reason == TaskReason::scanning) {
    return "Held still for a scan; once that has ended, release the pedal and press it to go on.";
  }
  const TaskWords words = kind_of(proposal.task->work).words(robot, proposal, status, found);
  switch (status.phase) {
    case TaskPhase::none:
    case TaskPhase::waiting:
      return (status.reason == TaskReason::press_again ? "Release the pedal and press it again"
                                                       : "Waits for the pedal") +
             words.waiting + ".";
    case TaskPhase::executing:
      return words.executing + ".";
    case TaskPhase::paused:
      return status.reason == TaskReason::unconfirmed
                 ? "Aligned. Look at it, confirm the insertion within 10 minutes, then press the pedal."
                 : words.paused + ".";
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
