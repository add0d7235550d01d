#include "robot/robot_file.hpp"

#include <algorithm>
#include <array>
#include <boost/crc.hpp>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <system_error>

#include "robot/modes.hpp"
#include "robot/readers.hpp"
#include "robot/table_reader.hpp"

namespace interlock {
namespace {

constexpr std::uintmax_t largest_file_bytes = std::uintmax_t{1} << 20;

std::string revision_of(std::string_view text) {
  boost::crc_32_type crc;
  crc.process_bytes(text.data(), text.size());
  std::array<char, 9> digits{};
  std::snprintf(digits.data(), digits.size(), "%08x", crc.checksum());
  return digits.data();
}

Pedal read_pedal(TableReader table, std::uint32_t period_us) {
  Pedal pedal;
  pedal.channels = table.integer<std::uint32_t>("channels");
  pedal.debounce_ticks = table.ticks("debounce_ms", period_us);
  pedal.disagree_ticks = table.ticks("disagree_ms", period_us);
  table.refuse_unknown_keys();
  return pedal;
}

LoopLimits read_loop(TableReader table, std::uint32_t period_us) {
  LoopLimits loop;
  loop.app_timeout_ticks = table.ticks("app_timeout_ms", period_us);
  loop.lease_max_ticks = table.ticks("lease_max_ms", period_us);
  loop.power_up_ticks = table.ticks("power_up_ms", period_us);
  loop.switch_debounce_ticks = table.ticks("switch_debounce_ms", period_us);
  loop.bad_frame_limit = table.integer<std::uint32_t>("bad_frame_limit");
  loop.overrun_limit = table.integer<std::uint32_t>("overrun_limit");
  table.refuse_unknown_keys();
  return loop;
}

void read_axes(TableReader& table, Robot& robot) {
  for (TableReader& entry : table.tables("axis", "one [[axis]] table for each motor")) {
    robot.axes.push_back(read_axis(std::move(entry), robot));
  }
}

std::vector<std::string> read_modes(TableReader& table) {
  const std::string expected = "\"manual\" first, and then each other mode of " + mode_names() + " once";
  std::vector<std::string> modes;
  for (std::string& mode : table.texts("modes", expected)) {
    if (!mode_of(mode)) {
      table.refuse("modes", "no mode is called \"" + mode + '"', expected);
    }
    if (std::ranges::find(modes, mode) != modes.end()) {
      table.refuse("modes", '"' + mode + "\" stands there twice", expected);
    }
    modes.push_back(std::move(mode));
  }
  if (modes.empty() || modes.front() != RobotMode::manual.name) {
    table.refuse("modes", "the first mode is not \"manual\"", expected);
  }
  return modes;
}

void read_sensors(TableReader& table, Robot& robot) {
  if (!table.has("sensor")) {
    return;
  }
  for (TableReader& entry : table.tables("sensor", "one [[sensor]] table for each sensor card")) {
    robot.sensors.push_back(read_sensor(std::move(entry), robot));
  }
}

/** "ADDRESS:PORT". */
void read_connect(TableReader& table, OpenIgtLink& link) {
  const std::string place = table.text("connect");
  const std::size_t colon = place.rfind(':');
  std::uint32_t port = 0;
  const char* const end = place.data() + place.size();
  const char* const digits = colon == std::string::npos ? end : place.data() + colon + 1;
  const auto [stopped, error] = std::from_chars(digits, end, port);
  if (colon == 0 || error != std::errc() || stopped != end || port == 0 || port > 65535) {
    table.refuse("connect", "\"" + place + "\" is no address with a port",
                 "the address and port of a program that listens, such as \"10.0.0.7:18944\"");
    return;
  }
  link.connect_address = place.substr(0, colon);
  link.connect_port = port;
}

OpenIgtLink read_openigtlink(TableReader table) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 3> dialects{
      {{"thesis", "thesis"}, {"brp2013", "brp2013"}, {"wpi2024", "wpi2024"}}};
  OpenIgtLink link;
  link.bind = table.text("bind");
  link.port = static_cast<std::uint32_t>(table.integer_between("port", 1, 65535));
  link.dialect = table.choice("dialect", dialects);
  if (table.has("allow")) {
    link.allow = table.texts("allow", "addresses of the machines that may connect");
  }
  if (table.has("heartbeat_ms")) {
    link.heartbeat_ms = static_cast<std::uint32_t>(table.integer_between("heartbeat_ms", 50, 10000));
  }
  if (table.has("connect")) {
    read_connect(table, link);
  }
  if (table.has("first_controls")) {
    link.first_controls = table.boolean("first_controls");
  }
  table.refuse_unknown_keys();
  return link;
}

/** What each mode but "manual" needs of the robot is there. */
void refuse_unserved_modes(TableReader& table, const Robot& robot) {
  if (robot.has_mode("home") && robot.home_steps.empty()) {
    table.refuse("modes", "there is no step of homing for the mode \"home\"",
                 "a [[home_step]], or no such mode");
  }
  if (robot.has_mode("draping") && robot.draping.empty()) {
    table.refuse("modes", "there are no setpoints for the mode \"draping\"",
                 "a [draping] table, or no such mode");
  }
  if (robot.has_mode("ablation") && robot.with_role("probe_rotation") == nullptr) {
    table.refuse("modes", "no probe can be turned for the mode \"ablation\"",
                 "an axis with the role probe_rotation, or no such mode");
  }
  const bool needle = robot.with_role("insertion") != nullptr && robot.with_role("rotation") != nullptr;
  if (robot.has_mode("cooperative_biopsy") && (!robot.biopsy || !needle)) {
    table.refuse("modes", "there is no needle, or nothing is said of it, for the mode \"cooperative_biopsy\"",
                 "axes with the roles insertion and rotation and a [biopsy] table, or no such mode");
  }
  const bool sweeps =
      std::ranges::any_of(robot.axes, [](const Axis& axis) { return axis.card == ILK_CARD_HIGH_FREQUENCY; });
  if (robot.has_mode("frequency_sweep") && !sweeps) {
    table.refuse("modes", "no axis has a high-frequency card for the mode \"frequency_sweep\"",
                 "an axis with such a card, or no such mode");
  }
  const auto alone = std::ranges::find_if(robot.axes, [](const Axis& axis) { return !axis.motion; });
  const auto needs_motion = std::ranges::find_if(robot.modes, [](const std::string& name) {
    const auto mode = mode_of(name);
    return mode && mode->needs_rates;
  });
  if (alone != robot.axes.end() && needs_motion != robot.modes.end()) {
    table.refuse("modes",
                 "the axis \"" + alone->name + "\" has no rates for the mode \"" + *needs_motion + '"',
                 "`motion` for each axis, or no such mode");
  }
}

/** A key that neither table has is refused with the table it is put in. */
void apply(const RobotSetting& setting, toml::table& root) {
  toml::table* const probe = root["probe"].as_table();
  toml::table* const table =
      probe != nullptr && probe->contains(setting.key) ? probe : root["kinematics"].as_table();
  if (table == nullptr) {
    return;
  }
  if (setting.numbers.size() == 1) {
    table->insert_or_assign(setting.key, setting.numbers.front());
    return;
  }
  toml::array point;
  for (const double number : setting.numbers) {
    point.push_back(number);
  }
  table->insert_or_assign(setting.key, std::move(point));
}

/** Of a socket's path, which has 107 bytes, folder and file take the rest. */
constexpr std::size_t longest_robot_name = 40;

Robot read_robot(ReadLog& log, const toml::table& root, std::span<const KinematicsFamily> families) {
  TableReader table(log, root, "");
  Robot robot;
  robot.name = table.identifier("name");
  if (robot.name.size() > longest_robot_name) {
    table.refuse("name", std::to_string(robot.name.size()) + " characters are given",
                 "at most " + std::to_string(longest_robot_name) +
                     ", since the paths of sockets have the name in them");
  }
  robot.title = table.text("title");
  robot.period_us = table.integer<std::uint32_t>("period_us");
  robot.modes = read_modes(table);
  robot.auto_approve = table.boolean("auto_approve");
  robot.pedal = read_pedal(table.table("pedal"), robot.period_us);
  robot.loop = read_loop(table.table("loop"), robot.period_us);
  read_kinematics(table, robot, families);
  read_axes(table, robot);
  refuse_unplayed_roles(table, robot);
  read_sensors(table, robot);
  read_home_steps(table, robot);
  read_draping(table, robot);
  read_biopsy(table, robot);
  if (table.has("openigtlink")) {
    robot.openigtlink = read_openigtlink(table.table("openigtlink"));
  }
  refuse_unserved_modes(table, robot);
  table.refuse_unknown_keys();
  return robot;
}

}  // namespace

tl::expected<Robot, RobotError> parse_robot(std::string_view text, std::string file,
                                            std::span<const KinematicsFamily> families,
                                            std::span<const RobotSetting> settings) {
  toml::table root;
  try {
    root = toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    return tl::unexpected(RobotError{std::move(file), error.source().begin.line, "",
                                     std::string(error.description()), "a TOML file"});
  }
  ReadLog log{{std::move(file), {}}, std::nullopt};
  for (const RobotSetting& setting : settings) {
    apply(setting, root);
  }
  Robot robot = read_robot(log, root, families);
  if (log.first_error) {
    return tl::unexpected(*log.first_error);
  }
  robot.origin = std::move(log.origin);
  robot.revision = revision_of(text);
  robot.text = text;
  return robot;
}

tl::expected<Robot, RobotError> load_robot(const std::filesystem::path& file,
                                           std::span<const RobotSetting> settings) {
  // Neither a device nor a stray recording may hold up the program or fill its memory.
  std::error_code error;
  const bool sensible = std::filesystem::file_size(file, error) <= largest_file_bytes && !error;
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (error || !stream) {
    return tl::unexpected(RobotError{file.string(), 0, "", "there is no such file, or it cannot be read",
                                     "a robot file such as models/robots/neuro.toml", true});
  }
  if (!sensible || !(text << stream.rdbuf())) {
    return tl::unexpected(RobotError{file.string(), 0, "", "the file is empty or is larger than 1 MiB",
                                     "a robot file such as models/robots/neuro.toml"});
  }
  return parse_robot(text.str(), file.string(), kinematics_families(), settings);
}

}  // namespace interlock
