#include "igtl/workphases.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace interlock::igtl {
namespace {

constexpr std::size_t prefix_width = 4;
/** Requests by which a repeated one is known. */
constexpr std::size_t remembered = 10;
constexpr const char* current_status_name = "CURRENT_STATUS";
constexpr const char* current_position_name = "CURRENT_POSITION";
constexpr const char* error_name = "ERROR";
constexpr const char* target_name = "TARGET";

std::string word_of(Phase phase) { return std::string(phase_name(phase)); }

Outgoings position_of(const RobotState& state) {
  if (!state.measured_cp) {
    return {};
  }
  return {{current_position_name, Transform{*state.measured_cp}}};
}

/** Whether the name is a prefix and an ID, by which its sender tells requests apart. */
bool has_id(const std::string& device) {
  constexpr std::array<std::string_view, 4> prefixes{"CMD_", "CLB_", "TGT_", "NPOS_"};
  return std::ranges::any_of(prefixes, [&](std::string_view each) { return device.starts_with(each); });
}

/** What stands behind the prefix. */
std::string id_of(const Message& message) {
  const auto end = message.device.find('_');
  return end == std::string::npos ? "" : message.device.substr(end + 1);
}

bool is_stop(Phase phase) { return phase == Phase::stop || phase == Phase::emergency; }

}  // namespace

Reaction Workphases::refuse(const std::string& name, StatusCode code, const std::string& reason,
                            std::int64_t sub_code) {
  Reaction reaction{{{name, Status{code, sub_code, "REFUSED", reason}}}, std::nullopt};
  reaction.refused = reason;
  return reaction;
}

Reaction Workphases::take_named(const Message& message, const RobotState& state, bool controls) {
  if (const auto* query = std::get_if<Query>(&message.body)) {
    return answer_query(*query, message.device, known(state), state);
  }
  if (const auto* start = std::get_if<StartTracking>(&message.body)) {
    return {{}, Track{start->interval_ms}};
  }
  if (std::holds_alternative<StopTracking>(message.body)) {
    return {{}, Track{}};
  }
  if (std::holds_alternative<Status>(message.body) || std::holds_alternative<Capability>(message.body) ||
      std::holds_alternative<TrackingReply>(message.body)) {
    return {};
  }
  if (is_repeated(message)) {
    return repeat(message);
  }
  Reaction reaction = take_request(message, state, controls);
  if (reaction.refused.empty()) {
    remember(message);
  }
  return reaction;
}

Reaction Workphases::take_request(const Message& message, const RobotState& state, bool controls) {
  const std::string prefix = message.device.substr(0, prefix_width);
  const std::string id = id_of(message);
  if (prefix == "CMD_") {
    return request(id, message, state, controls);
  }
  if (prefix == "CLB_") {
    return calibrate(id, message);
  }
  return prefix == "TGT_" ? target(id, message) : take_other(message, state);
}

/** The same name and the same content as one of the last requests that were taken. A stop is none: whoever
 * sends it again means it. */
bool Workphases::is_repeated(const Message& message) const {
  const auto* text = std::get_if<Text>(&message.body);
  const auto phase = text == nullptr ? std::nullopt : requested_phase(text->text);
  return !(phase && is_stop(*phase)) &&
         std::ranges::find(taken_, Outgoing(message.device, message.body)) != taken_.end();
}

/** It is acknowledged once more, and not carried out once more. */
Reaction Workphases::repeat(const Message& message) const {
  Reaction reaction{{{"ACK_" + id_of(message), message.body}}, std::nullopt};
  reaction.replies.emplace_back(current_status_name, current_status(StatusCode::ok));
  reaction.refused = "The same request came before under this ID; it is not carried out again.";
  return reaction;
}

void Workphases::remember(const Message& message) {
  if (!has_id(message.device)) {
    return;
  }
  std::erase_if(taken_, [&](const Outgoing& each) { return each.first == message.device; });
  taken_.emplace_back(message.device, message.body);
  if (taken_.size() > remembered) {
    taken_.pop_front();
  }
}

Outgoings Workphases::refuse_broken(const std::string& device, const Status& fault) const {
  Status told = fault;
  told.text = device + ": " + fault.text;
  return {{error_name, told}};
}

/** As its phase, but for the acknowledgement: there is no ID to acknowledge. */
Reaction Workphases::stop(StopName name) {
  Reaction reaction;
  enter(name == StopName::stop ? Phase::stop : Phase::emergency, reaction);
  return reaction;
}

/** CMD_: a phase is asked for. */
Reaction Workphases::request(const std::string& id, const Message& message, const RobotState& state,
                             bool controls) {
  const auto* text = std::get_if<Text>(&message.body);
  if (text == nullptr) {
    return refuse(error_name, StatusCode::configuration,
                  message.device + " came as " + type_of(message.body) + "; expected STRING.");
  }
  Reaction reaction{{{"ACK_" + id, *text}}, std::nullopt};
  const auto desired = requested_phase(text->text);
  StatusCode code = StatusCode::ok;
  if (!desired) {
    code = StatusCode::unknown_instruction;
    reaction.refused = "There is no phase \"" + text->text + "\"; docs/openigtlink.md lists them.";
    reaction.replies.emplace_back(error_name, Status{code, 0, "UNKNOWN", reaction.refused});
    return reaction;
  }
  if (!is_stop(*desired)) {
    code = controls ? StatusCode::not_ready : StatusCode::access_denied;
    reaction.refused = controls ? forbids(*desired, state)
                                : "This connection is an observer; whoever is in control makes it "
                                  "the controller in the console's panel Navigation.";
  }
  if (reaction.refused.empty()) {
    enter(*desired, reaction);
    return reaction;
  }
  reaction.replies.emplace_back(current_status_name, current_status(code, reaction.refused));
  reaction.replies.emplace_back(word_of(*desired), Status{code, 0, "REFUSED", reaction.refused});
  return reaction;
}

void Workphases::enter(Phase desired, Reaction& reaction) {
  const Phase from = std::exchange(phase_, desired);
  before_ = is_stop(from) ? before_ : from;
  drop_motion(reaction);
  reaction.replies.emplace_back(current_status_name, current_status(StatusCode::ok));
  const auto tell = [&](StatusCode code, const std::string& reason) {
    const bool refused = code != StatusCode::ok;
    reaction.refused = refused ? reason : "";
    reaction.replies.emplace_back(word_of(desired), Status{code, 0, refused ? "REFUSED" : "OK", reason});
  };
  switch (desired) {
    case Phase::start_up:
      set_goal(Goal::start_up, StartUp{}, reaction);
      break;
    case Phase::planning:
    case Phase::calibration:
      if (tells_every_entry()) {
        tell(StatusCode::ok, "");
      }
      break;
    case Phase::targeting:
      if (calibrated_) {
        tell(StatusCode::ok, "");
      } else {
        tell(uncalibrated(), "No calibration came by this connection; send CLB_ in the phase CALIBRATION.");
      }
      break;
    case Phase::move_to_target:
      if (from == Phase::manual) {
        tell(StatusCode::not_ready, "The motors have no power after MANUAL; begin with START_UP.");
      } else if (!has_target_) {
        tell(StatusCode::not_ready, "There is no target; send TGT_ in the phase TARGETING.");
      } else {
        set_goal(Goal::target, MoveToTarget{}, reaction);
      }
      break;
    case Phase::manual:
      reaction.command = CutPower{};
      break;
    case Phase::stop:
    case Phase::emergency:
      reaction.command = Stop{desired == Phase::emergency};
      break;
    case Phase::undefined:
      break;
  }
  if (reaction.command && desired != Phase::move_to_target) {
    expected_[word_of(desired)] = std::nullopt;
  }
}

void Workphases::set_goal(Goal goal, Command command, Reaction& reaction) {
  drop_motion(reaction);
  goal_ = goal;
  reaction.command = std::move(command);
}

void Workphases::drop_motion(Reaction& reaction) {
  if (motion_) {
    reaction.ends = std::exchange(motion_, std::nullopt);
  }
  goal_ = Goal::nothing;
}

/** CLB_: the robot's pose in the scanner. */
Reaction Workphases::calibrate(const std::string& id, const Message& message) {
  const auto* matrix = std::get_if<Transform>(&message.body);
  if (matrix == nullptr) {
    return refuse(word_of(Phase::calibration), StatusCode::configuration,
                  message.device + " came as " + type_of(message.body) + "; expected TRANSFORM.");
  }
  Reaction reaction{{{"ACK_" + id, *matrix}}, SetRegistration{matrix->matrix}};
  if (phase_ != Phase::calibration) {
    reaction.command.reset();
    reaction.refused = "A calibration is taken in the phase CALIBRATION alone.";
    reaction.replies.emplace_back(word_of(Phase::calibration),
                                  Status{StatusCode::not_ready, 0, "REFUSED", reaction.refused});
    return reaction;
  }
  expected_[word_of(Phase::calibration)] = std::nullopt;
  return reaction;
}

/** TGT_: the pose that the probe is to have. */
Reaction Workphases::target(const std::string& id, const Message& message) {
  const auto* matrix = std::get_if<Transform>(&message.body);
  if (matrix == nullptr) {
    return refuse(target_name, StatusCode::configuration,
                  message.device + " came as " + type_of(message.body) + "; expected TRANSFORM.");
  }
  Reaction reaction{{{"ACK_" + id, *matrix}}, SetTargetPose{matrix->matrix}};
  if (!takes_target() || !calibrated_) {
    reaction.command.reset();
    reaction.refused = calibrated_ ? "No target is taken in the phase " + word_of(phase_) + "."
                                   : "No calibration came by this connection.";
    reaction.replies.emplace_back(target_name, Status{StatusCode::not_ready, 0, "REFUSED", reaction.refused});
    return reaction;
  }
  drop_motion(reaction);
  expected_[target_name] = std::nullopt;
  return reaction;
}

Reaction Workphases::finish(const std::string& /*device*/, const Command& command, const Outcome& outcome) {
  // What failed or was stopped may be asked for again, under whatever ID.
  if (outcome.status.code != StatusCode::ok || std::holds_alternative<Stop>(command)) {
    taken_.clear();
  }
  if (std::holds_alternative<SetRegistration>(command)) {
    return finish_calibration(outcome);
  }
  if (std::holds_alternative<SetTargetPose>(command)) {
    return finish_target(outcome);
  }
  if (std::holds_alternative<StartUp>(command)) {
    return settle(Goal::start_up, outcome);
  }
  if (std::holds_alternative<MoveToTarget>(command)) {
    return settle(Goal::target, outcome);
  }
  std::string name;
  bool is_answered = true;
  if (const auto* stop = std::get_if<Stop>(&command)) {
    name = word_of(stop->cuts_power ? Phase::emergency : Phase::stop);
    is_answered = stop->is_answered;
  } else if (std::holds_alternative<CutPower>(command)) {
    name = word_of(Phase::manual);
  } else {
    return finish_other(command, outcome);
  }
  expected_.erase(name);
  return is_answered ? Reaction{{{name, outcome.status}}, std::nullopt} : Reaction{};
}

Reaction Workphases::finish_calibration(const Outcome& outcome) {
  const std::string name = word_of(Phase::calibration);
  expected_.erase(name);
  Reaction reaction{{{name, outcome.status}}, std::nullopt};
  if (outcome.status.code == StatusCode::ok) {
    calibrated_ = true;
    const Outgoings more = has_target_ ? after_storing(outcome) : Outgoings{};
    reaction.replies.insert(reaction.replies.end(), more.begin(), more.end());
  }
  return reaction;
}

/** A target that is refused leaves none: nobody shall go to the one before unawares. */
Reaction Workphases::finish_target(const Outcome& outcome) {
  expected_.erase(target_name);
  has_target_ = outcome.target.has_value();
  Status status = outcome.status;
  status.code = status.code == StatusCode::unreachable ? StatusCode::configuration : status.code;
  status.sub_code = has_sub_codes() ? status.sub_code : 0;
  Reaction reaction{{{target_name, status}}, std::nullopt};
  if (has_target_) {
    reaction.replies.emplace_back(target_name, Transform{*outcome.target});
  }
  const Outgoings more = after_storing(outcome);
  reaction.replies.insert(reaction.replies.end(), more.begin(), more.end());
  if (has_target_ && phase_ == Phase::move_to_target) {
    set_goal(Goal::target, MoveToTarget{}, reaction);
  }
  return reaction;
}

Reaction Workphases::settle(Goal goal, const Outcome& outcome) {
  if (outcome.proposal && goal_ == goal) {
    Reaction reaction;
    reaction.ends = std::exchange(motion_, outcome.proposal);
    return reaction;
  }
  Reaction reaction;
  reaction.ends = outcome.proposal;
  if (goal_ == goal) {
    goal_ = Goal::nothing;
  }
  const std::string name = name_of(goal);
  expected_.erase(name);
  reaction.replies.emplace_back(
      name, outcome.proposal ? Status{StatusCode::not_ready, 0, "REPLACED", "Another phase was asked for."}
                             : outcome.status);
  return reaction;
}

std::string Workphases::name_of(Goal goal) {
  switch (goal) {
    case Goal::start_up:
      return std::string(phase_name(Phase::start_up));
    case Goal::retraction:
      return "RETRACT_NEEDLE";
    case Goal::target:
    case Goal::nothing:
      break;
  }
  return std::string(phase_name(Phase::move_to_target));
}

Reaction Workphases::take_other(const Message& message, const RobotState& /*state*/) {
  return refuse(
      error_name, StatusCode::unknown_instruction,
      "The name \"" + message.device + "\" means nothing here; docs/openigtlink.md lists the names.");
}

Reaction Workphases::finish_other(const Command& /*command*/, const Outcome& /*outcome*/) { return {}; }

Outgoings Workphases::after_storing(const Outcome& /*outcome*/) const { return {}; }

Outgoings Workphases::follow(const Motion& motion, const RobotState& state) {
  if (motion_ != motion.proposal || !motion.is_over) {
    return {};
  }
  motion_.reset();
  if (motion.status.code != StatusCode::ok) {
    taken_.clear();
  }
  const Goal goal = std::exchange(goal_, Goal::nothing);
  const std::string name = name_of(goal);
  expected_.erase(name);
  Status status = motion.status;
  status.sub_code = 0;
  Outgoings replies{{name, status}};
  if (goal == Goal::target) {
    const Outgoings last = position_of(state);
    replies.insert(replies.end(), last.begin(), last.end());
  }
  return replies;
}

Status Workphases::current_status(StatusCode code, std::string text) const {
  return {code, 0, word_of(phase_), std::move(text)};
}

Outgoings Workphases::known(const RobotState& state) const {
  const bool is_known = phase_ != Phase::undefined;
  Outgoings messages = position_of(state);
  if (has_target_ && state.desired_cp) {
    messages.emplace_back("TARGET_POSITION", Transform{*state.desired_cp});
  }
  if (calibrated_ && state.scanner_from_robot) {
    messages.emplace_back("CALIBRATION", Transform{*state.scanner_from_robot});
  }
  messages.emplace_back(current_status_name,
                        current_status(is_known ? StatusCode::ok : StatusCode::configuration));
  return messages;
}

Outgoings Workphases::told(const RobotState& state) const {
  if (state.health.code == StatusCode::ok) {
    return {};
  }
  return {{error_name, state.health}};
}

Outgoings Workphases::heartbeat(Time now, const RobotState& state, bool has_to_hear) {
  Outgoings due;
  if (phase_ == Phase::move_to_target && goal_ != Goal::nothing) {
    due = position_of(state);
  }
  if (due.empty() && has_to_hear) {
    due.emplace_back(current_status_name, current_status(StatusCode::ok));
  }
  for (auto& [name, since] : expected_) {
    since = since.value_or(now);
    if (now - *since > longest_silence) {
      since = Time::max();
      due.emplace_back(name, Status{StatusCode::busy, 0, "BUSY",
                                    goal_ == Goal::nothing
                                        ? "It is still being done."
                                        : "Motion waits for approval, for the pedal, or is not over yet."});
    }
  }
  return due;
}

}  // namespace interlock::igtl
