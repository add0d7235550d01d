#include "igtl/dialect.hpp"

#include <algorithm>
#include <charconv>

namespace interlock::igtl {
namespace {

Capability capabilities() {
  return {{"TRANSFORM", "STRING", "STATUS", "POINT", "POSITION", "NDARRAY", "TDATA", "GET_CAPABIL",
           "STT_TDATA", "STP_TDATA"}};
}

/** In ms behind the word, or the usual validity where nothing follows it. */
std::optional<std::chrono::milliseconds> validity_in(std::string_view behind) {
  if (behind.empty()) {
    return usual_gate_signal;
  }
  std::int64_t ms = 0;
  const char* const end = behind.data() + behind.size();
  const auto [stopped, error] = std::from_chars(behind.data() + 1, end, ms);
  const std::chrono::milliseconds validity(ms);
  const bool is_valid = behind.front() == ' ' && error == std::errc() && stopped == end &&
                        validity >= shortest_gate_signal && validity <= longest_gate_signal;
  return is_valid ? std::optional(validity) : std::nullopt;
}

std::optional<HoldMessage> hold_in(bool is_scan, std::string_view text) {
  if (is_scan) {
    const bool is_known = text == "on" || text == "off";
    return is_known ? std::optional<HoldMessage>(ScanState{text == "on"}) : std::nullopt;
  }
  const std::string_view word = text.substr(0, text.find(' '));
  const auto validity = validity_in(text.substr(word.size()));
  const bool is_known = validity && (word == "open" || word == "hold");
  return is_known ? std::optional<HoldMessage>(GateSignal{word == "open", *validity}) : std::nullopt;
}

}  // namespace

std::optional<tl::expected<HoldMessage, Unwanted>> read_hold(const Message& message) {
  const auto* text = std::get_if<Text>(&message.body);
  const std::string name = lower(message.device);
  const bool is_scan = name == "scan";
  if (text == nullptr || !(is_scan || name == "breathing_gate")) {
    return std::nullopt;
  }
  if (auto hold = hold_in(is_scan, lower(text->text))) {
    return *hold;
  }
  return unwanted(
      StatusCode::configuration,
      message.device + " is \"" + text->text + "\"; expected " +
          (is_scan ? "on or off." : "open or hold, and the ms for which it is valid: 50 to 2000."));
}

std::optional<StopName> stop_name(std::string_view device) {
  const std::string name = lower(device);
  if (name == "stop") {
    return StopName::stop;
  }
  return name == "emergency" ? std::optional(StopName::emergency) : std::nullopt;
}

bool may_ask_to_stop(std::string_view device) {
  const std::string name = lower(device.substr(device.rfind('/') + 1));
  return name == "mode" || name == "state_command" || name.starts_with("cmd_");
}

bool asks_to_stop(const Message& message) {
  const auto* text = std::get_if<Text>(&message.body);
  const std::string asked = text == nullptr ? "" : lower(text->text);
  return stop_name(message.device) ||
         (may_ask_to_stop(message.device) && (asked == "stop" || asked == "emergency" || asked == "pause"));
}

Reaction Dialect::take(const Message& message, const RobotState& state, bool controls) {
  const auto name = stop_name(message.device);
  if (!name) {
    return take_named(message, state, controls);
  }
  Reaction reaction = stop(*name);
  if (std::holds_alternative<Status>(message.body)) {
    std::get<Stop>(*reaction.command).is_answered = false;
  }
  return reaction;
}

Reaction Dialect::take_broken(const std::string& device, const Status& fault) {
  const auto name = stop_name(device);
  Reaction reaction = name ? stop(*name) : Reaction{};
  const Outgoings told = refuse_broken(device, fault);
  reaction.replies.insert(reaction.replies.begin(), told.begin(), told.end());
  return reaction;
}

bool needs_control(const Command& command) noexcept {
  return !std::holds_alternative<Stop>(command) && !std::holds_alternative<Track>(command) &&
         !std::holds_alternative<Noted>(command);
}

TrackingData tracking_of(const RobotState& state) {
  constexpr std::uint8_t six_degrees = 2;
  TrackingData data;
  if (state.scanner_from_robot) {
    data.tools.push_back({"scanner_to_robot_reg", six_degrees, *state.scanner_from_robot});
  }
  if (state.measured_cp) {
    data.tools.push_back({"measured_cp", six_degrees, *state.measured_cp});
  }
  if (state.desired_cp) {
    data.tools.push_back({"desired_cp", six_degrees, *state.desired_cp});
  }
  return data;
}

Reaction answer_query(const Query& query, const std::string& device, const Outgoings& known,
                      const RobotState& state) {
  if (asks_for(query, "CAPABILITY")) {
    return {{{device, capabilities()}}, std::nullopt};
  }
  if (asks_for(query, "TDATA")) {
    return {{{device, tracking_of(state)}}, std::nullopt};
  }
  Reaction reaction;
  std::ranges::copy_if(known, std::back_inserter(reaction.replies), [&](const Outgoing& each) {
    return asks_for(query, type_of(each.second)) && (device.empty() || device == each.first);
  });
  if (reaction.replies.empty()) {
    reaction.refused = "There is no " + query.type + " \"" + device + "\" now.";
    reaction.replies.emplace_back(device, Status{StatusCode::not_found, 0, "NOT_FOUND", reaction.refused});
  }
  return reaction;
}

std::string lower(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(), [](char each) {
    return each >= 'A' && each <= 'Z' ? static_cast<char>(each + 32) : each;
  });
  return result;
}

}  // namespace interlock::igtl
