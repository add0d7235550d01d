#include <array>
#include <charconv>
#include <cmath>
#include <initializer_list>

#include "igtl/header.hpp"
#include "igtl/workphases.hpp"

namespace interlock::igtl {
namespace {

constexpr double longest_needle_mm = 1000.0;

constexpr std::uint32_t set_of(std::initializer_list<Phase> phases) {
  std::uint32_t set = 0;
  for (const Phase phase : phases) {
    set |= 1u << static_cast<unsigned>(phase);
  }
  return set;
}

constexpr bool has(std::uint32_t set, Phase phase) {
  return ((set >> static_cast<unsigned>(phase)) & 1u) != 0;
}

/** Phases that may follow, in the order of `Phase`; STOP and EMERGENCY always may. */
constexpr std::array<std::uint32_t, 9> next_phases{
    set_of({Phase::start_up}),
    set_of({Phase::calibration, Phase::manual}),
    set_of({Phase::targeting, Phase::calibration, Phase::start_up, Phase::manual}),
    set_of({Phase::planning, Phase::start_up, Phase::manual}),
    set_of({Phase::start_up, Phase::planning, Phase::calibration, Phase::move_to_target, Phase::manual}),
    set_of({Phase::start_up, Phase::planning, Phase::calibration, Phase::targeting, Phase::manual}),
    set_of({Phase::start_up}),
    set_of({Phase::start_up, Phase::calibration, Phase::planning, Phase::manual}),
    set_of({Phase::start_up, Phase::calibration, Phase::planning, Phase::manual})};

bool is_at(const std::optional<Matrix>& measured, const std::optional<Matrix>& desired, double tolerance_mm) {
  return measured && desired &&
         std::hypot((*measured)[3] - (*desired)[3], (*measured)[7] - (*desired)[7],
                    (*measured)[11] - (*desired)[11]) <= tolerance_mm;
}

}  // namespace

std::string Wpi2024::forbids(Phase desired, const RobotState& state) const {
  const bool was_stopped = phase() == Phase::stop || phase() == Phase::emergency;
  const bool comes_back = was_stopped && desired == phase_before() &&
                          (desired == Phase::targeting || desired == Phase::move_to_target);
  const std::string way = std::string(phase_name(phase())) + " to " + std::string(phase_name(desired));
  if (!comes_back && !has(next_phases[static_cast<std::size_t>(phase())], desired)) {
    return "There is no way from " + way + ".";
  }
  if (phase() == Phase::move_to_target && (!state.is_probe_out || goal() == Goal::retraction)) {
    return "The needle is not out, which the way from " + way + " needs; send RETRACT_NEEDLE first.";
  }
  return {};
}

Outgoings Wpi2024::after_storing(const Outcome& outcome) const {
  if (!outcome.reachable) {
    return {};
  }
  return {{"REACHABLE_TARGET", Transform{*outcome.reachable}}};
}

Reaction Wpi2024::take_other(const Message& message, const RobotState& state) {
  if (message.device.starts_with("NPOS_")) {
    return needle_tip(message);
  }
  const auto* text = std::get_if<Text>(&message.body);
  return text == nullptr ? Workphases::take_other(message, state) : take_text(message.device, *text, state);
}

Reaction Wpi2024::take_text(const std::string& name, const Text& text, const RobotState& state) {
  if (name == "CURRENT_POSITION") {
    return position(state);
  }
  if (name == "NEEDLE_LENGTH") {
    return needle_length(text);
  }
  if (name == "RETRACT_NEEDLE") {
    return retract();
  }
  if (name == "CURV_METHOD" || name == "ALPHA") {
    return refuse("ACK_" + name, StatusCode::unknown_instruction,
                  "Steering is not tuned from the network; the robot's file says how it steers.");
  }
  return refuse(("ACK_" + name).substr(0, device_width), StatusCode::invalid,
                "The name \"" + name + "\" means nothing here; docs/openigtlink.md lists the names.");
}

Reaction Wpi2024::position(const RobotState& state) const {
  Reaction reaction;
  if (state.measured_cp) {
    reaction.replies.emplace_back("CURRENT_POSITION", Transform{*state.measured_cp});
  }
  const bool reached = has_target() && is_at(state.measured_cp, state.desired_cp, reached_mm);
  reaction.replies.emplace_back("IS_IN_TARGETING_POS", Text{state.is_probe_out ? "1" : "0"});
  reaction.replies.emplace_back("HAS_REACHED_TARGET", Text{reached ? "1" : "0"});
  return reaction;
}

/** Noted: the probe's offsets are set in the console. */
Reaction Wpi2024::needle_length(const Text& text) const {
  constexpr const char* name = "ACK_NEEDLE_LENGTH";
  double mm = 0.0;
  const char* const end = text.text.data() + text.text.size();
  const auto [stopped, error] = std::from_chars(text.text.data(), end, mm);
  if (phase() != Phase::start_up) {
    return refuse(name, StatusCode::not_ready, "A needle's length is taken in the phase START_UP alone.");
  }
  if (error != std::errc() || stopped != end || !(mm > 0.0 && mm <= longest_needle_mm)) {
    return refuse(name, StatusCode::configuration,
                  "The length is \"" + text.text + "\"; expected a number in mm up to 1000, such as 150.");
  }
  return {{{name, text}}, std::nullopt};
}

Reaction Wpi2024::retract() {
  if (phase() != Phase::move_to_target) {
    return refuse("ACK_RETRACT_NEEDLE", StatusCode::not_ready,
                  "The needle is retracted in the phase MOVE_TO_TARGET alone.");
  }
  Reaction reaction{{{"ACK_RETRACT_NEEDLE", Status{StatusCode::ok, 0, "OK", ""}}}, std::nullopt};
  set_goal(Goal::retraction, RetractProbe{}, reaction);
  return reaction;
}

/** NPOS_: where an imager sees the needle's tip. */
Reaction Wpi2024::needle_tip(const Message& message) const {
  constexpr const char* name = "MOVE_TO_TARGET";
  const auto* matrix = std::get_if<Transform>(&message.body);
  if (matrix == nullptr) {
    return refuse(name, StatusCode::configuration,
                  message.device + " came as " + type_of(message.body) + "; expected TRANSFORM.");
  }
  Reaction reaction{{{"ACK_" + message.device.substr(5), *matrix}}, ReportPose{matrix->matrix}};
  if (phase() != Phase::move_to_target) {
    reaction.command.reset();
    reaction.refused = "The needle's tip is taken in the phase MOVE_TO_TARGET alone.";
    reaction.replies.emplace_back(name, Status{StatusCode::not_ready, 0, "REFUSED", reaction.refused});
  }
  return reaction;
}

Reaction Wpi2024::finish_other(const Command& command, const Outcome& outcome) {
  if (std::holds_alternative<RetractProbe>(command)) {
    return settle(Goal::retraction, outcome);
  }
  return {{{"MOVE_TO_TARGET", outcome.status}}, std::nullopt};
}

}  // namespace interlock::igtl
