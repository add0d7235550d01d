#include "igtl/crtk.hpp"

#include <vector>

namespace interlock::igtl {
namespace {

constexpr const char* arm = "arm/";
constexpr std::string_view measured_cp = "measured_cp";

/** Positions, and velocities below them once these are known. */
Array joint_states(const RobotState& state) {
  Array array{{1, static_cast<std::uint16_t>(state.measured_jp.size())}, state.measured_jp};
  if (state.measured_jv.size() == state.measured_jp.size()) {
    array.size[0] = 2;
    array.values.insert(array.values.end(), state.measured_jv.begin(), state.measured_jv.end());
  }
  return array;
}

Sensor six(const Spatial& values) { return {0, 0, {values.begin(), values.end()}}; }

Outgoings named_states(const RobotState& state) {
  Outgoings messages;
  if (state.measured_cp) {
    messages.emplace_back(measured_cp, Transform{*state.measured_cp});
  }
  if (state.desired_cp) {
    messages.emplace_back("setpoint_cp", Transform{*state.desired_cp});
  }
  if (!state.measured_jp.empty()) {
    messages.emplace_back("measured_js", joint_states(state));
  }
  if (state.measured_cv) {
    messages.emplace_back("measured_cv", six(*state.measured_cv));
  }
  if (state.measured_cf) {
    messages.emplace_back("measured_cf", six(*state.measured_cf));
  }
  if (!state.operating_state.empty()) {
    messages.emplace_back("operating_state", Text{state.operating_state});
  }
  const bool is_well = state.health.code == StatusCode::ok;
  messages.emplace_back(is_well ? "status" : "error", Text{state.health.text});
  return messages;
}

/** Each by its own name and by that in the arm's namespace. */
Outgoings with_arm(Outgoings messages) {
  const std::size_t count = messages.size();
  for (std::size_t i = 0; i < count; ++i) {
    messages.emplace_back(arm + messages[i].first, messages[i].second);
  }
  return messages;
}

Reading state_command(const Message& message) {
  const auto* text = std::get_if<Text>(&message.body);
  if (text == nullptr) {
    return unwanted(StatusCode::configuration,
                    message.device + " came as " + type_of(message.body) + "; expected STRING.");
  }
  const std::string command = lower(text->text);
  if (command == "home") {
    return StartUp{};
  }
  if (command == "pause") {
    return Stop{};
  }
  if (command == "disable") {
    return CutPower{};
  }
  if (command == "enable" || command == "resume" || command == "unhome") {
    return unwanted(StatusCode::access_denied,
                    "\"" + command +
                        "\" is not done from the network: axes are enabled in the console, and "
                        "motion goes on when somebody presses the pedal.");
  }
  return unwanted(StatusCode::unknown_instruction,
                  "There is no command \"" + text->text + "\"; expected home, pause or disable.");
}

}  // namespace

Outgoings crtk_messages(const RobotState& state) {
  Outgoings messages = with_arm(named_states(state));
  // It has that name in the thesis, too.
  std::erase_if(messages, [](const Outgoing& each) { return each.first == measured_cp; });
  return messages;
}

Outgoings crtk_event(const Motion& motion) {
  const bool is_well = motion.status.code == StatusCode::ok;
  const std::string what = "Proposal " + std::to_string(motion.proposal) + " is " + motion.status.name + ". ";
  return with_arm({{is_well ? "status" : "warning", Text{what + motion.status.text}}});
}

std::optional<Reading> crtk_command(std::string_view name, const Message& message) {
  const auto slash = name.rfind('/');
  const std::string_view command = name.substr(slash == std::string_view::npos ? 0 : slash + 1);
  if (command == "state_command") {
    return state_command(message);
  }
  if (!command.starts_with("servo_") && !command.starts_with("move_")) {
    return std::nullopt;
  }
  return unwanted(StatusCode::access_denied,
                  message.device +
                      " would be a setpoint, and none is taken from the network; send entry and "
                      "target or a trajectory, then a MODE that somebody approves.");
}

}  // namespace interlock::igtl
