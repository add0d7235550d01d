#include "service/positions_file.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <tuple>

#include "robot/compile.hpp"
#include "service/fields.hpp"

namespace interlock {
namespace {

using nlohmann::json;

constexpr const char* format_name = "interlock-positions";
constexpr std::int64_t format_version = 1;
constexpr std::int64_t lowest = std::numeric_limits<std::int32_t>::min();
constexpr std::int64_t highest = std::numeric_limits<std::int32_t>::max();

tl::unexpected<Problem> another(const char* code, const std::string& detail, const std::string& field,
                                const std::string& expected) {
  Problem problem = invalid(field, detail, expected);
  problem.status = Status::conflict;
  problem.code = code;
  problem.next_step = "Choose a file that was saved by this robot as it is now.";
  return tl::make_unexpected(problem);
}

std::string crc_text(std::uint32_t crc) {
  std::array<char, 9> text{};
  std::snprintf(text.data(), text.size(), "%08x", static_cast<unsigned>(crc));
  return text.data();
}

bool is_crc(const std::string& text) {
  return text.size() == 8 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

/** A file of another version may have fields that nobody knows here, so its version is looked at first. */
tl::expected<void, Problem> check_version(const json& file, const std::string& where) {
  json head = json::object();
  for (const char* key : {"format", "version"}) {
    if (file.is_object() && file.contains(key)) {
      head[key] = file[key];
    }
  }
  Fields fields(file.is_object() ? head : file, {"format", "version"}, where);
  constexpr std::array<std::string_view, 1> formats{format_name};
  (void)fields.choice("format", formats);
  const auto version = fields.integer("version", 1, highest);
  fields.require({{"format", format_name}, {"version", "1"}});
  if (fields.problem()) {
    return tl::make_unexpected(*fields.problem());
  }
  if (*version != format_version) {
    return another("POSITIONS_VERSION", "The file has version " + std::to_string(*version) + ".",
                   fields.place_of("version"), "version 1");
  }
  return {};
}

tl::expected<SavedAxis, Problem> read_axis(const json& entry, const Robot& robot, const std::string& where) {
  Fields fields(entry, {"axis", "position_counts", "setpoint_counts", "enabled", "homed"}, where);
  const auto name = fields.text("axis");
  const auto position = fields.integer("position_counts", lowest, highest);
  const auto setpoint = fields.integer_or_null("setpoint_counts", lowest, highest);
  const auto enabled = fields.boolean("enabled");
  const auto homed = fields.boolean("homed");
  fields.require({{"axis", "name of an axis"},
                  {"position_counts", "an integer"},
                  {"setpoint_counts", "an integer or null"},
                  {"enabled", "true or false"},
                  {"homed", "true or false"}});
  const Axis* axis = name ? robot.find(*name) : nullptr;
  if (name && axis == nullptr) {
    fields.reject("axis", "is " + *name + ", which this robot does not have", "an axis of " + robot.name);
  }
  if (fields.problem()) {
    return tl::make_unexpected(*fields.problem());
  }
  SavedAxis saved{axis->slot, static_cast<std::int32_t>(*position), std::nullopt, *enabled, *homed};
  if (setpoint) {
    saved.setpoint_counts = static_cast<std::int32_t>(*setpoint);
  }
  return saved;
}

tl::expected<std::vector<SavedAxis>, Problem> read_axes(const json& list, const Robot& robot,
                                                        const std::string& where) {
  std::vector<SavedAxis> found;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string place = where + "[" + std::to_string(i) + "]";
    const auto axis = read_axis(list[i], robot, place);
    if (!axis) {
      return tl::make_unexpected(axis.error());
    }
    if (std::any_of(found.begin(), found.end(),
                    [&](const SavedAxis& each) { return each.slot == axis->slot; })) {
      return tl::make_unexpected(invalid(place + ".axis",
                                         place + ".axis names " + robot.at_slot(axis->slot)->name + " again.",
                                         "each axis once"));
    }
    found.push_back(*axis);
  }
  return found;
}

/** In the order of the robot's file; every axis must be there. */
tl::expected<std::vector<SavedAxis>, Problem> in_order(const std::vector<SavedAxis>& found,
                                                       const Robot& robot, const std::string& where) {
  std::vector<SavedAxis> ordered;
  for (const Axis& axis : robot.axes) {
    const auto saved = std::find_if(found.begin(), found.end(),
                                    [&](const SavedAxis& each) { return each.slot == axis.slot; });
    if (saved == found.end()) {
      return tl::make_unexpected(
          invalid(where, where + " lacks " + axis.name + ".", "every axis of " + robot.name));
    }
    ordered.push_back(*saved);
  }
  return ordered;
}

}  // namespace

const SavedAxis* SavedPositions::at_slot(std::uint32_t slot) const {
  const auto found =
      std::find_if(axes.begin(), axes.end(), [&](const SavedAxis& each) { return each.slot == slot; });
  return found == axes.end() ? nullptr : &*found;
}

json positions_file(const Robot& robot, const ControlView& view, const OpenTargets& targets, UtcTime now) {
  json axes = json::array();
  for (const Axis& axis : robot.axes) {
    const ilk_axis_t& state = view.snapshot.state.axis[axis.slot];
    const OpenTarget& target = targets[axis.slot];
    axes.push_back({{"axis", axis.name},
                    {"position_counts", state.position_counts},
                    {"setpoint_counts", target.open ? json(target.target_counts) : json()},
                    {"enabled", state.state != ILK_AXIS_DISABLED && state.state != ILK_AXIS_FAULTED},
                    {"homed", state.homed != 0}});
  }
  return {{"format", format_name},  {"version", format_version},
          {"robot", robot.name},    {"config_crc", crc_text(view.snapshot.config_crc)},
          {"saved", iso_8601(now)}, {"axes", std::move(axes)}};
}

std::string positions_file_name(const Robot& robot, UtcTime now) {
  std::string time = iso_8601(now).substr(0, std::string_view("2024-05-01T12:34:56").size());
  std::erase_if(time, [](char letter) { return letter == '-' || letter == ':'; });
  return robot.name + "-positions-" + time + "Z.json";
}

tl::expected<SavedPositions, Problem> read_positions(const json& file, const Robot& robot,
                                                     const ilk_config_t& config, const std::string& where) {
  if (const auto version = check_version(file, where); !version) {
    return tl::make_unexpected(version.error());
  }
  Fields fields(file, {"format", "version", "robot", "config_crc", "saved", "axes"}, where);
  const auto name = fields.text("robot");
  const auto crc = fields.text("config_crc");
  const auto saved_text = fields.text("saved");
  fields.require({{"robot", "name of a robot"},
                  {"config_crc", "eight hex digits"},
                  {"saved", "a time"},
                  {"axes", "a list"}});
  if (crc && !is_crc(*crc)) {
    fields.reject("config_crc", "is " + *crc, "eight hex digits in lower case");
  }
  const auto saved = parse_iso_8601(saved_text.value_or(""));
  if (saved_text && !saved) {
    fields.reject("saved", "is " + *saved_text, "a time in UTC as 2024-05-01T12:34:56.789Z");
  }
  if (fields.has("axes") && !fields.value("axes")->is_array()) {
    fields.reject("axes", "is no list", "a list of axes");
  }
  if (fields.problem()) {
    return tl::make_unexpected(*fields.problem());
  }
  if (*name != robot.name) {
    return another("POSITIONS_ROBOT", "The file is of the robot " + *name + ".", fields.place_of("robot"),
                   robot.name);
  }
  if (*crc != config_hash(config)) {
    return another("POSITIONS_CONFIG", "The file is of the configuration " + *crc + ".",
                   fields.place_of("config_crc"), config_hash(config));
  }
  const std::string place = fields.place_of("axes");
  return read_axes(*fields.value("axes"), robot, place)
      .and_then([&](const std::vector<SavedAxis>& axes) { return in_order(axes, robot, place); })
      .map([&](std::vector<SavedAxis> axes) { return SavedPositions{*saved, std::move(axes)}; });
}

json compare_positions(const SavedPositions& saved, const Robot& robot, const ilk_config_t& config,
                       const ControlView& view) {
  json rows = json::array();
  for (const SavedAxis& each : saved.axes) {
    const ilk_axis_config_t& rules = config.axis[each.slot];
    rows.push_back({{"slot", each.slot},
                    {"axis", robot.at_slot(each.slot)->name},
                    {"now_counts", view.snapshot.state.axis[each.slot].position_counts},
                    {"saved_counts", each.position_counts},
                    {"setpoint_counts", each.setpoint_counts ? json(*each.setpoint_counts) : json()},
                    {"enabled", each.enabled},
                    {"homed", each.homed},
                    {"restorable",
                     each.position_counts >= rules.min_counts && each.position_counts <= rules.max_counts}});
  }
  return {{"saved", iso_8601(saved.saved)}, {"axes", std::move(rows)}};
}

}  // namespace interlock
