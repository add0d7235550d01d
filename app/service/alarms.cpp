#include "service/alarms.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "interlock/sim_bus.h"
#include "robot/catalog.hpp"
#include "store/audit.hpp"

namespace interlock {
namespace {

using catalog::Family;
using nlohmann::json;

constexpr std::chrono::seconds silence{1};
/** What comes this soon after this computer was late may come from that. */
constexpr std::chrono::seconds after_lateness{2};
/** Of a second, in which simulated time waited for this computer. */
constexpr std::uint32_t late_us = 500'000;
/** Faults of cards this near to one another come from what they share. */
constexpr std::uint32_t together_us = 1'000'000;

/** Without what its value means, which is not given here. */
std::string sentence(std::string_view meaning) {
  return std::string(meaning.substr(0, meaning.find(" Value: ")));
}

std::optional<AlarmPriority> priority_of_lock(std::uint32_t cause) {
  switch (cause) {
    case ILK_CAUSE_ESTOP:
    case ILK_CAUSE_INTEGRITY:
    case ILK_CAUSE_RUNAWAY:
      return AlarmPriority::high;
    case ILK_CAUSE_BUS:
    case ILK_CAUSE_PEDAL:
    case ILK_CAUSE_OVERRUN:
      return AlarmPriority::medium;
    default:
      return std::nullopt;
  }
}

const char* layer_of_lock(std::uint32_t cause) {
  switch (cause) {
    case ILK_CAUSE_ESTOP:
      return "person";
    case ILK_CAUSE_INTEGRITY:
      return "kernel";
    case ILK_CAUSE_BUS:
      return "bus";
    case ILK_CAUSE_OVERRUN:
      return "computer";
    case ILK_CAUSE_PEDAL:
      return "pedal";
    default:
      return "axis";
  }
}

bool is_of_card(std::uint32_t fault) {
  return fault == ILK_FAULT_CARD || fault == ILK_FAULT_CARD_RESET || fault == ILK_FAULT_JUMP;
}

AlarmCondition* with_code(std::vector<AlarmCondition>& found, std::string_view code) {
  const auto each = std::ranges::find(found, code, &AlarmCondition::code);
  return each == found.end() ? nullptr : &*each;
}

/** "Yaw", "Yaw and Pitch", "Yaw, Pitch and 5 more". */
std::string listed(const std::vector<std::string>& titles) {
  constexpr std::size_t most = 2;
  std::string text = titles.front();
  for (std::size_t place = 1; place < std::min(most, titles.size()); ++place) {
    text += (titles.size() == most ? " and " : ", ") + titles[place];
  }
  return titles.size() > most ? text + " and " + std::to_string(titles.size() - most) + " more" : text;
}

/** Worse first. */
bool comes_before(const Alarm& left, const Alarm& right) {
  const auto rank = [](const Alarm& alarm) {
    return std::tuple(-static_cast<int>(alarm.condition.priority), alarm.acknowledged.has_value(), alarm.id);
  };
  return rank(left) < rank(right);
}

}  // namespace

std::string_view alarm_priority_name(AlarmPriority priority) noexcept {
  constexpr std::array<std::string_view, alarm_priorities> names{"low", "medium", "high"};
  return names[static_cast<std::size_t>(priority)];
}

json to_json(const Alarm& alarm) {
  const AlarmCondition& condition = alarm.condition;
  std::string text = condition.text;
  if (condition.layer == "computer" && condition.code != "LATE") {
    text += " This computer was late just before: look there first.";
  }
  return {{"id", alarm.id},
          {"code", condition.code},
          {"priority", alarm_priority_name(condition.priority)},
          {"layer", condition.layer},
          {"text", std::move(text)},
          {"next_step", condition.next_step},
          {"axes", condition.axes},
          {"begun", iso_8601(alarm.begun)},
          {"last", iso_8601(alarm.last)},
          {"count", alarm.count},
          {"ended", alarm.ended ? json(iso_8601(*alarm.ended)) : json()},
          {"acknowledged", alarm.acknowledged ? json{{"user", alarm.acknowledged->user},
                                                     {"time", iso_8601(alarm.acknowledged->time)}}
                                              : json()}};
}

std::vector<Alarm> Alarms::see(const ControlView& view, SteadyTime now, UtcTime time) {
  std::vector<AlarmCondition> found = conditions(view, now);
  std::vector<Alarm> changed;
  for (Alarm& alarm : present_) {
    const auto still = std::ranges::find(found, alarm.condition.code, &AlarmCondition::code);
    if (still == found.end()) {
      alarm.ended = time;
      changed.push_back(alarm);
      past_.push_front(alarm);
      continue;
    }
    if (alarm.condition.layer == "computer") {
      still->layer = "computer";
    }
    if (*still != alarm.condition) {
      const bool more = still->axes.size() > alarm.condition.axes.size();
      alarm.acknowledged = more ? std::nullopt : alarm.acknowledged;
      alarm.condition = std::move(*still);
      changed.push_back(alarm);
    }
    found.erase(still);
  }
  std::erase_if(present_, [](const Alarm& alarm) { return alarm.ended.has_value(); });
  for (AlarmCondition& condition : found) {
    const auto before = std::ranges::find_if(past_, [&](const Alarm& alarm) {
      return alarm.condition.code == condition.code && time - *alarm.ended < same_within;
    });
    if (before == past_.end()) {
      present_.push_back({.id = ++last_id_,
                          .condition = std::move(condition),
                          .begun = time,
                          .last = time,
                          .ended = {},
                          .acknowledged = {}});
    } else {
      Alarm again = std::move(*before);
      past_.erase(before);
      again.condition = std::move(condition);
      again.last = time;
      ++again.count;
      again.ended.reset();
      again.acknowledged.reset();
      present_.push_back(std::move(again));
    }
    changed.push_back(present_.back());
  }
  past_.resize(std::min(past_.size(), most_past));
  if (!changed.empty()) {
    std::ranges::sort(present_, comes_before);
  }
  return changed;
}

std::vector<AlarmCondition> Alarms::conditions(const ControlView& view, SteadyTime now) {
  std::vector<AlarmCondition> found;
  if (view.replay) {
    return found;
  }
  if (!view.attached) {
    no_kernel_since_ = no_kernel_since_.value_or(now);
    if (now - *no_kernel_since_ >= silence) {
      found.push_back({"NO_KERNEL", AlarmPriority::medium, "kernel",
                       "No kernel is connected: nothing is known of the robot.",
                       "If anything moves, pull the E-stop. Start interlock-kernel, or look at its log."});
    }
  } else {
    no_kernel_since_.reset();
    if (now - view.received >= silence) {
      const bool simulated = view.snapshot.simulated != 0;
      found.push_back({"SILENT", AlarmPriority::medium, simulated ? "simulator" : "kernel",
                       std::string("The kernel") +
                           (simulated ? ", or the simulator that it waits for," : "") +
                           " has shown nothing new for more than a second.",
                       "If anything moves, pull the E-stop. Look at the kernel's log."});
    }
    add_computer(found, view.snapshot, now);
    add_lock(found, view.snapshot.state.system, now);
    add_faults(found, view.snapshot);
  }
  if (!registration_expired_.empty()) {
    found.push_back({"REGISTRATION", AlarmPriority::low, "person",
                     "The registration has expired: " + registration_expired_,
                     "Set it again before the next target."});
  }
  const bool has_worse = std::ranges::any_of(
      found, [](const AlarmCondition& each) { return each.priority != AlarmPriority::low; });
  // One that ends while something worse is there ended by that.
  const bool is_new = std::exchange(motion_just_ended_, false);
  if (is_new && has_worse) {
    ended_motion_.reset();
  }
  if (ended_motion_) {
    found.push_back(*ended_motion_);
  }
  return found;
}

void Alarms::add_computer(std::vector<AlarmCondition>& found, const ilk_snapshot_t& snapshot,
                          SteadyTime now) {
  const bool missed = overruns_ && snapshot.overruns > *overruns_;
  overruns_ = snapshot.overruns;
  const bool waited = snapshot.lateness.second_us >= late_us;
  if (missed || waited) {
    late_ = now;
  }
  if (late_ && now - *late_ < after_lateness) {
    found.push_back({"LATE", AlarmPriority::low, "computer",
                     snapshot.clock == ILK_CLOCK_SIM
                         ? "This computer is too busy: simulated time waits for it."
                         : "This computer is too busy: ticks of the control loop came late.",
                     "Stop what else runs on it."});
  }
}

void Alarms::add_lock(std::vector<AlarmCondition>& found, const ilk_system_t& system, SteadyTime now) {
  if (system.mode == ILK_MODE_INIT) {
    const catalog::Entry& entry = catalog::entry(Family::mode, ILK_MODE_INIT);
    found.push_back(
        {"INIT", AlarmPriority::medium, "kernel", std::string(entry.meaning), std::string(entry.next_step)});
  }
  const auto add = [&](std::uint32_t cause) {
    const catalog::Entry& entry = catalog::entry(Family::cause, cause);
    if (const auto priority = priority_of_lock(cause)) {
      found.push_back({std::string(entry.name), *priority, layer_of_lock(cause), sentence(entry.meaning),
                       std::string(entry.next_step)});
    }
  };
  if (system.mode == ILK_MODE_LOCKED) {
    add(system.cause);
    if (system.cause == ILK_CAUSE_PEDAL && system.pedal != ILK_PEDAL_DISAGREE) {
      found.back().text = "The pedal's channels disagreed, and agree again.";
      found.back().next_step = "Press Unlock; if it comes again, replace the pedal.";
    }
  }
  // What keeps a lock that another cause began. Channels disagree for a moment in each press.
  if (system.estop != 0 && with_code(found, "ESTOP") == nullptr) {
    add(ILK_CAUSE_ESTOP);
  }
  disagree_since_ =
      system.pedal == ILK_PEDAL_DISAGREE ? std::optional(disagree_since_.value_or(now)) : std::nullopt;
  if (disagree_since_ && now - *disagree_since_ >= silence && with_code(found, "PEDAL") == nullptr) {
    add(ILK_CAUSE_PEDAL);
  }
}

/** Until its own fault is cleared, whichever of the others were before. */
bool Alarms::was_lost_with_others(const std::string& axis) const {
  const std::string bus = catalog::name(Family::cause, ILK_CAUSE_BUS);
  return std::ranges::any_of(present_, [&](const Alarm& alarm) {
    return alarm.condition.code == bus &&
           std::ranges::find(alarm.condition.axes, axis) != alarm.condition.axes.end();
  });
}

void Alarms::add_faults(std::vector<AlarmCondition>& found, const ilk_snapshot_t& snapshot) const {
  const ilk_system_t& system = snapshot.state.system;
  const std::uint32_t together = together_us / std::max(1u, snapshot.period_us);
  std::optional<std::uint32_t> shared;  // when what cards share failed
  if (system.mode == ILK_MODE_LOCKED && system.cause == ILK_CAUSE_BUS) {
    shared = system.cause_tick;
  }
  const auto fault_at = [&](const Axis& axis) { return snapshot.state.axis[axis.slot]; };
  const auto near = [&](std::uint32_t left, std::uint32_t right) {
    return std::min(left - right, right - left) <= together;
  };
  for (const Axis& axis : robot_.axes) {
    for (const Axis& other : robot_.axes) {
      const bool both =
          axis.slot < other.slot && is_of_card(fault_at(axis).fault) && is_of_card(fault_at(other).fault);
      if (!shared && both && near(fault_at(axis).fault_tick, fault_at(other).fault_tick)) {
        shared = fault_at(axis).fault_tick;
      }
    }
  }
  const bool late = with_code(found, "LATE") != nullptr;
  std::vector<std::vector<std::string>> titles;
  titles.resize(found.size());
  for (const Axis& axis : robot_.axes) {
    const ilk_axis_t& now = fault_at(axis);
    if (now.fault == ILK_FAULT_NONE) {
      continue;
    }
    const bool with_others = is_of_card(now.fault) &&
                             ((shared && near(now.fault_tick, *shared)) || was_lost_with_others(axis.name));
    const catalog::Entry& entry =
        with_others ? catalog::entry(Family::cause, ILK_CAUSE_BUS) : catalog::entry(Family::fault, now.fault);
    AlarmCondition* group = with_code(found, entry.name);
    if (group == nullptr) {
      const char* const layer = now.fault == ILK_FAULT_INTEGRITY ? "kernel"
                                : is_of_card(now.fault)          ? "card"
                                                                 : "axis";
      found.push_back({std::string(entry.name), AlarmPriority::medium, with_others ? "bus" : layer,
                       sentence(entry.meaning), std::string(entry.next_step)});
      group = &found.back();
    }
    group->axes.push_back(axis.name);
    titles.resize(found.size());
    titles[static_cast<std::size_t>(group - found.data())].push_back(axis.title);
  }
  for (std::size_t place = 0; place < titles.size(); ++place) {
    AlarmCondition& group = found[place];
    if (titles[place].empty()) {
      continue;
    }
    if (group.code == catalog::name(Family::cause, ILK_CAUSE_BUS)) {
      group.text = listed(titles[place]) + ": cards were lost together, so hardly by a cable of one.";
      const std::string share =
          snapshot.simulated != 0 ? "the simulator" : "power and cable of the card rack";
      group.next_step = "Look at what they share: " + share + ", and this computer. Then " +
                        (system.mode == ILK_MODE_LOCKED ? "unlock, " : "") +
                        "clear the faults, enable the axes and home them.";
      group.layer = snapshot.simulated != 0 ? "simulator" : "bus";
    } else {
      group.text = listed(titles[place]) + ": " + group.text;
    }
    const bool by_cards = group.layer == "bus" || group.layer == "card" || group.layer == "simulator";
    group.layer = late && by_cards ? "computer" : group.layer;
  }
}

void Alarms::follow(const Proposal& proposal) {
  const bool ended = proposal.state == ProposalState::aborted || proposal.state == ProposalState::refused ||
                     proposal.state == ProposalState::expired;
  if (proposal.state == ProposalState::executing) {
    ended_motion_.reset();
  } else if (ended && proposal.changed_by == audit_actor::app) {
    note_ended_motion(proposal.id, proposal.detail, proposal.axes);
  }
}

void Alarms::note_ended_motion(std::int64_t number, const std::string& why, std::vector<std::string> axes) {
  motion_just_ended_ = true;
  ended_motion_ = {"MOTION",
                   AlarmPriority::low,
                   "axis",
                   "Motion " + std::to_string(number) + " ended by itself. " + why,
                   "Look at the robot; propose it again if it is still wanted.",
                   std::move(axes)};
}

const Alarm* Alarms::find(std::uint32_t id) const {
  const auto present = std::ranges::find(present_, id, &Alarm::id);
  if (present != present_.end()) {
    return &*present;
  }
  const auto past = std::ranges::find(past_, id, &Alarm::id);
  return past == past_.end() ? nullptr : &*past;
}

void Alarms::acknowledge(std::uint32_t id, const Acknowledgement& by) {
  const auto alarm = std::ranges::find(present_, id, &Alarm::id);
  if (alarm == present_.end() || alarm->acknowledged) {
    return;
  }
  alarm->acknowledged = by;
  if (ended_motion_ && alarm->condition == *ended_motion_) {
    ended_motion_.reset();
  }
  std::ranges::sort(present_, comes_before);
}

json Alarms::to_json() const {
  json list = json::array();
  for (const Alarm& alarm : present_) {
    list.push_back(interlock::to_json(alarm));
  }
  return {{"alarms", std::move(list)}};
}

}  // namespace interlock
