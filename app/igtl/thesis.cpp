#include "igtl/thesis.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "igtl/crtk.hpp"

namespace interlock::igtl {
namespace {

tl::unexpected<Unwanted> wrong_type(const Message& message, const char* expected) {
  return unwanted(StatusCode::configuration,
                  message.device + " came as " + type_of(message.body) + "; expected " + expected + ".");
}

template <typename Made>
Reading with_matrix(const Message& message) {
  const auto* transform = std::get_if<Transform>(&message.body);
  return transform != nullptr ? Reading(Made{transform->matrix}) : wrong_type(message, "TRANSFORM");
}

/** One point, or the origin of a pose, as different programs send it. */
Reading point_of(const Message& message, bool is_target) {
  if (const auto* points = std::get_if<Points>(&message.body)) {
    if (points->points.size() != 1) {
      return unwanted(
          StatusCode::configuration,
          message.device + " holds " + std::to_string(points->points.size()) + " points; expected one.");
    }
    return SetPoint{is_target, points->points[0].position};
  }
  if (const auto* transform = std::get_if<Transform>(&message.body)) {
    return SetPoint{is_target, {transform->matrix[3], transform->matrix[7], transform->matrix[11]}};
  }
  if (const auto* position = std::get_if<Position>(&message.body)) {
    return SetPoint{is_target, position->position};
  }
  return wrong_type(message, "POINT, POSITION or TRANSFORM");
}

/** A finite number that is the whole text. */
std::optional<double> number_of(const std::string& text) {
  double number = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, number);
  const bool whole = error == std::errc() && stopped == end && std::isfinite(number);
  return whole ? std::optional(number) : std::nullopt;
}

Reading offset_of(const Message& message, std::string_view field) {
  const auto* text = std::get_if<Text>(&message.body);
  if (text == nullptr) {
    return wrong_type(message, "STRING");
  }
  const std::optional<double> mm = number_of(text->text);
  if (!mm) {
    return unwanted(StatusCode::configuration,
                    message.device + " is \"" + text->text + "\"; expected a number in mm, such as 12.5.");
  }
  return SetOffset{field, *mm};
}

Reading rows_of(const std::string& device, const Array& array) {
  if (array.size.size() != 2) {
    return unwanted(StatusCode::configuration, device + " has " + std::to_string(array.size.size()) +
                                                   " dimensions; expected two, rows and columns.");
  }
  return LoadRows{array.size[1], array.values};
}

/** Each element of a TDATA is a pose, and its name the time. */
Reading poses_of(const std::string& device, const TrackingData& data) {
  LoadPoses command;
  for (const Tool& tool : data.tools) {
    const std::optional<double> time_s = number_of(tool.name);
    if (!time_s) {
      return unwanted(StatusCode::configuration,
                      device + ", row " + std::to_string(command.poses.size() + 1) + ", name: \"" +
                          tool.name + "\" is no time; expected a number in s, such as 0.25.");
    }
    command.poses.push_back({*time_s, tool.matrix});
  }
  return command;
}

Reading trajectory_of(const Message& message) {
  if (const auto* array = std::get_if<Array>(&message.body)) {
    return rows_of(message.device, *array);
  }
  const auto* data = std::get_if<TrackingData>(&message.body);
  return data != nullptr ? poses_of(message.device, *data) : wrong_type(message, "NDARRAY or TDATA");
}

Reading mode_of_text(const Message& message) {
  const auto* text = std::get_if<Text>(&message.body);
  if (text == nullptr) {
    return wrong_type(message, "STRING");
  }
  std::string mode = lower(text->text);
  if (mode == "stop" || mode == "emergency") {
    return Stop{};
  }
  return mode == "home" ? Reading(StartUp{}) : Reading(SetMode{std::move(mode)});
}

/** Heard from an imager, and noted when it can be one. */
Reading tip_pose(const Message& message) {
  const auto* transform = std::get_if<Transform>(&message.body);
  if (transform == nullptr) {
    return wrong_type(message, "TRANSFORM");
  }
  if (!is_rigid(transform->matrix)) {
    return unwanted(StatusCode::configuration,
                    message.device + " is no rigid motion; expected R^T R = 1 within 0.0001, determinant 1.");
  }
  return Noted{true, TipPose{transform->matrix}};
}

constexpr std::string_view imager_status_name = "imager_status";

Reading imager_text(const Message& message) {
  const auto* text = std::get_if<Text>(&message.body);
  return text == nullptr ? wrong_type(message, "STRING or STATUS")
                         : Reading(Noted{true, ImagerStatus{std::nullopt, "", text->text}});
}

/** A STATUS under any name shows that its sender lives; under that of the imager it also says how it is. */
Noted noted_status(const Message& message, const Status& status) {
  if (lower(message.device) != imager_status_name) {
    return Noted{false};
  }
  return Noted{false, ImagerStatus{status.code, status.name, status.text}};
}

/** One name of the dialect. */
struct Name {
  std::string_view name;
  Reading (*read)(const Message&);
};

constexpr std::array<Name, 13> names{{
    {"registration", with_matrix<SetRegistration>},
    {"current_pose", with_matrix<ReportPose>},
    {"tip_pose", tip_pose},
    {imager_status_name, imager_text},
    {"entry_point", [](const Message& message) { return point_of(message, false); }},
    {"target_point", [](const Message& message) { return point_of(message, true); }},
    {"treatment_to_tip",
     [](const Message& message) { return offset_of(message, "treatment_to_tip_offset"); }},
    {"robot_to_entry", [](const Message& message) { return offset_of(message, "robot_to_entry_offset"); }},
    {"cannula_to_treatment",
     [](const Message& message) { return offset_of(message, "cannula_to_treatment_offset"); }},
    {"robot_treatment_home",
     [](const Message& message) { return offset_of(message, "treatment_to_robot_at_home"); }},
    {"trajectory", trajectory_of},
    {"mode", mode_of_text},
    {"start_up", [](const Message&) -> Reading { return StartUp{}; }},
}};

Reading named(const Message& message) {
  const std::string name = lower(message.device);
  const auto found = std::ranges::find(names, name, &Name::name);
  if (found != names.end()) {
    return found->read(message);
  }
  if (auto command = crtk_command(name, message)) {
    return std::move(*command);
  }
  return unwanted(
      StatusCode::unknown_instruction,
      "The name \"" + message.device + "\" means nothing here; docs/openigtlink.md lists the names.");
}

std::string listed(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) {
    std::array<char, 32> digits{};
    const int length = std::snprintf(digits.data(), digits.size(), "%.6g", value);
    text += (text.empty() ? "" : ",") + std::string(digits.data(), static_cast<std::size_t>(length));
  }
  return text;
}

Points point(const char* name, const Position3& position) {
  return {{{name, "Fiducial", {255, 0, 0, 255}, position, 0.0, ""}}};
}

}  // namespace

Reaction Thesis::take_named(const Message& message, const RobotState& state, bool /*controls*/) {
  if (const auto* query = std::get_if<Query>(&message.body)) {
    return answer_query(*query, message.device, messages_of(state), state);
  }
  auto command = read_change(message);
  if (!command) {
    const Unwanted& why = command.error();
    return {{{message.device, Status{why.code, 0, "UNWANTED", why.reason}}}, std::nullopt, {}, why.reason};
  }
  if (const auto* noted = std::get_if<Noted>(&*command)) {
    Reaction reaction;
    if (noted->is_answered) {
      reaction = finish(message.device, *command, {{StatusCode::ok, 0, "OK", "Noted."}});
    }
    reaction.word = noted->word;
    return reaction;
  }
  return {{}, std::move(*command)};
}

Outgoings Thesis::refuse_broken(const std::string& device, const Status& fault) const {
  return {{device, fault}};
}

Reaction Thesis::stop(StopName /*name*/) { return {{}, Stop{}}; }

Reaction Thesis::finish(const std::string& device, const Command& command, const Outcome& outcome) {
  if (const auto* stop = std::get_if<Stop>(&command); stop != nullptr && !stop->is_answered) {
    return {};
  }
  return {{{device, outcome.status}}, std::nullopt};
}

Outgoings Thesis::follow(const Motion& motion, const RobotState& /*state*/) {
  Outgoings messages{{"proposal", motion.status}};
  const Outgoings events = crtk_event(motion);
  messages.insert(messages.end(), events.begin(), events.end());
  return messages;
}

Outgoings Thesis::heartbeat(Time /*now*/, const RobotState& state, bool has_to_hear) {
  return has_to_hear ? Outgoings{{"robot_status", state.health}} : Outgoings{};
}

Outgoings Thesis::told(const RobotState& state) const { return messages_of(state); }

Reading read_change(const Message& message) {
  if (const auto* start = std::get_if<StartTracking>(&message.body)) {
    return Track{start->interval_ms};
  }
  if (std::holds_alternative<StopTracking>(message.body)) {
    return Track{};
  }
  if (const auto* status = std::get_if<Status>(&message.body)) {
    return noted_status(message, *status);
  }
  if (std::holds_alternative<Capability>(message.body) ||
      std::holds_alternative<TrackingReply>(message.body)) {
    return Noted{false};
  }
  return named(message);
}

Outgoings messages_of(const RobotState& state) {
  Outgoings messages{
      {"treatment_to_tip", Text{listed({state.treatment_to_tip_mm})}},
      {"robot_to_entry", Text{listed({state.robot_to_entry_mm})}},
      {"cannula_to_treatment", Text{listed({state.cannula_to_treatment_mm})}},
      {"robot_treatment_home", Text{listed({state.treatment_to_robot_at_home_mm})}},
      {"mode", Text{state.mode}},
      {"registration_state", Text{state.registration_problem.empty() ? "VALID" : state.registration_problem}},
      {"robot_status", state.health}};
  if (state.scanner_from_robot) {
    messages.emplace_back("scanner_to_robot_reg", Transform{*state.scanner_from_robot});
  }
  if (state.entry) {
    messages.emplace_back("entry_point", point("entry_point", *state.entry));
  }
  if (state.target) {
    messages.emplace_back("target_point", point("target_point", *state.target));
  }
  if (state.desired_cp) {
    messages.emplace_back("desired_cp", Transform{*state.desired_cp});
  }
  if (!state.desired_jp.empty()) {
    messages.emplace_back("desired_jp", Text{listed(state.desired_jp)});
  }
  if (state.measured_cp) {
    messages.emplace_back("measured_cp", Transform{*state.measured_cp});
  }
  if (!state.measured_jp.empty()) {
    messages.emplace_back("measured_jp", Text{listed(state.measured_jp)});
  }
  if (!state.measured_jv.empty()) {
    messages.emplace_back("measured_jv", Text{listed(state.measured_jv)});
  }
  const Outgoings more = crtk_messages(state);
  messages.insert(messages.end(), more.begin(), more.end());
  return messages;
}

}  // namespace interlock::igtl
