/** @file Every number of a robot file, and values of it that cannot be: each is refused where it stands. */
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "robot/compile.hpp"
#include "robot/robot_file.hpp"

namespace interlock {
namespace {

/** By table and key: values that no robot can have, beside those that no number can have. */
const std::map<std::string, std::vector<std::string>> impossible{
    {"period_us", {"0", "124", "2001"}},
    {"pedal.channels", {"0", "3"}},
    {"pedal.debounce_ms", {"0", "51"}},
    {"pedal.disagree_ms", {"0", "51"}},
    {"loop.app_timeout_ms", {"0", "1", "151"}},
    {"loop.lease_max_ms", {"0", "1", "151"}},
    {"loop.power_up_ms", {"0", "5001"}},
    {"loop.switch_debounce_ms", {"0", "1", "21"}},
    {"loop.bad_frame_limit", {"0", "6"}},
    {"loop.overrun_limit", {"0", "11"}},
    {"kinematics.side_link_mm", {"0", "-1", "1001"}},
    {"kinematics.top_width_mm", {"0", "-1", "1001"}},
    {"kinematics.home_separation_mm", {"0", "-1", "1001"}},
    {"kinematics.min_separation_mm", {"0", "-1", "1001"}},
    {"kinematics.max_separation_mm", {"0", "-1", "1001"}},
    {"kinematics.driver_to_rcm_mm", {"0", "-1", "1001"}},
    {"kinematics.home_rcm_mm", {"-1001", "1001"}},
    {"kinematics.calibration_mm", {"-0.1", "100.1"}},
    {"kinematics.lower_height_mm", {"-1001", "1001"}},
    {"kinematics.upper_height_mm", {"-1001", "1001"}},
    {"kinematics.stage_distance_mm", {"0", "-1", "1001"}},
    {"kinematics.needle_tip_mm", {"0", "-1", "1001"}},
    {"kinematics.front_pivot_offset_mm", {"-1001", "1001"}},
    {"kinematics.needle_height_mm", {"-1001", "1001"}},
    {"kinematics.needle_guide_mm", {"0", "-1", "1001"}},
    {"kinematics.base_to_zframe_mm", {"-1001", "1001"}},
    {"kinematics.max_angulation_rad", {"-0.1", "1.1"}},
    {"kinematics.tool.xyz_mm", {"-1001", "1001"}},
    {"kinematics.tool.rpy_rad", {"-6.3", "6.3"}},
    {"kinematics.joint.xyz_mm", {"-1001", "1001"}},
    {"kinematics.joint.rpy_rad", {"-6.3", "6.3"}},
    {"kinematics.joint.direction", {"0.5", "2"}},
    {"kinematics.joint.limits_mm", {"-0.1", "60.1", "1001"}},
    {"kinematics.joint.limits_rad", {"-0.61", "0.61", "1001"}},
    {"probe.treatment_to_tip_mm", {"-1001", "1001"}},
    {"probe.robot_to_entry_mm", {"-1001", "1001"}},
    {"probe.cannula_to_treatment_mm", {"-1001", "1001"}},
    {"probe.treatment_to_robot_at_home_mm", {"-1001", "1001"}},
    {"targeting.tolerance_mm", {"0", "-1", "101"}},
    {"targeting.tolerance_deg", {"0", "-1", "91"}},
    {"targeting.registration.origin_mm", {"-1001", "1001"}},
    {"targeting.registration.origin_tolerance_mm", {"0", "-1", "1001"}},
    {"targeting.registration.rotation", {"0.5", "2"}},
    {"targeting.registration.rotation_tolerance_deg", {"0", "-1", "181"}},
    {"axis.slot", {"-1", "10"}},
    {"axis.encoder_resolution", {"0", "4294967295"}},
    {"axis.counts_per_unit", {"0", "-1", "1e-9", "1e10"}},
    {"axis.motor_direction", {"-1", "2"}},
    {"axis.direction_correction", {"-1", "2"}},
    {"axis.home_offset_counts", {"-2147483648", "2147483647"}},
    {"axis.soft_limits.min_counts", {"-2147483648", "2147483647"}},
    {"axis.soft_limits.max_counts", {"-2147483648", "2147483647"}},
    {"axis.deadband_counts", {"0", "4294967295"}},
    {"axis.drive.max", {"0", "4294967295"}},
    {"axis.drive.min", {"-1", "4294967295"}},
    {"axis.drive.dead_zone", {"-1", "4294967295"}},
    {"axis.drive.unhomed_max", {"0", "4294967295"}},
    {"axis.drive.max_amplitude", {"0", "256"}},
    {"axis.drive.resonance_hz", {"-1001", "1001"}},
    {"axis.gains.position_per_s", {"-1", "1e7"}},
    {"axis.gains.velocity", {"-1", "1e7"}},
    {"axis.gains.integral_per_s", {"-1", "1e7"}},
    {"axis.mechanics.coast_counts", {"0", "4294967295"}},
    {"axis.mechanics.backlash_counts", {"-1", "4294967295"}},
    {"axis.mechanics.noise_counts", {"-1", "4294967295"}},
    {"axis.mechanics.max_delta_counts", {"0", "4294967295"}},
    {"axis.mechanics.full_speed_counts_per_s", {"0", "100000001"}},
    {"axis.mechanics.tool_play_counts", {"-1", "10001"}},
    {"axis.mechanics.rest_ms", {"0", "2", "1001"}},
    {"axis.stall.driven_ms", {"0", "2", "501"}},
    {"axis.stall.effort_ms", {"0", "201"}},
    {"axis.stall.min_counts", {"0", "4294967295"}},
    {"axis.runaway.reverse_counts", {"0", "4294967295"}},
    {"axis.runaway.drift_counts", {"0", "4294967295"}},
    {"axis.unhomed_travel_counts", {"0", "4294967295"}},
    {"axis.motion.velocity_counts_per_s", {"0", "-1", "1e10"}},
    {"axis.motion.acceleration_counts_per_s2", {"0", "-1", "1e10"}},
    {"axis.motion.jerk_counts_per_s3", {"0", "-1", "1e10"}},
    {"axis.motion.following_error_counts", {"0", "2", "4294967295"}},
    {"axis.homing.drive", {"0", "4294967295"}},
    {"axis.homing.amplitude", {"0", "256"}},
    {"axis.homing.slow_drive", {"0", "4294967295"}},
    {"axis.homing.speed_counts_per_s", {"0", "4294967295"}},
    {"axis.homing.slow_speed_counts_per_s", {"0", "4294967295"}},
    {"axis.homing.travel_counts", {"0", "4294967295"}},
    {"axis.homing.clear_counts", {"0", "4294967295"}},
    {"axis.homing.tolerance_counts", {"0", "4294967295"}},
    {"axis.homing.hysteresis_counts", {"-1", "4294967295"}},
    {"axis.homing.timeout_ms", {"0", "600001"}},
    {"sensor.slot", {"-1", "10"}},
    {"sensor.channel.adc", {"0", "5"}},
    {"sensor.channel.slope", {"0", "1e-300", "1e10"}},
    {"sensor.channel.intercept", {"-1e10", "1e10"}},
    {"sensor.channel.reference", {"-1", "65536"}},
    {"home_step.nudge", {"0", "2147483647"}},
    {"home_step.move", {"-2147483648", "2147483647"}},
    {"draping", {"-2147483648", "2147483647"}},
    {"biopsy.units_per_newton", {"0", "-1", "1e7"}},
    {"biopsy.entry_mm", {"-1", "169", "501"}},
    {"biopsy.deadband_n", {"-1", "101"}},
    {"biopsy.gain_mm_s_n", {"0", "-1", "101"}},
    {"biopsy.fastest_mm_s", {"0", "-1", "101"}},
    {"biopsy.curvature_per_mm", {"0", "-1", "0.2"}},
    {"biopsy.membranes_mm", {"0", "-1", "501"}},
    {"openigtlink.port", {"0", "65536"}},
    {"openigtlink.heartbeat_ms", {"49", "10001"}},
};

/** Keys of which a value that others contradict may be refused at the line of the other. */
const std::set<std::string> judged_with_others{"period_us", "axis.mechanics.full_speed_counts_per_s",
                                               "axis.mechanics.rest_ms", "axis.stall.min_counts",
                                               "axis.homing.speed_counts_per_s"};

std::string text_of(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/** Files that have every key between them. */
const std::vector<std::string>& robots() {
  static const std::vector<std::string> texts{
      text_of(INTERLOCK_ROBOTS "/neuro.toml") +
          "\n[openigtlink]\nbind = \"::1\"\nport = 18944\ndialect = \"thesis\"\nheartbeat_ms = 200\n",
      text_of(INTERLOCK_ROBOTS "/prostate.toml"), text_of(INTERLOCK_TEST_ROBOTS "/gantry.toml"),
      text_of(INTERLOCK_TEST_ROBOTS "/trainer.toml")};
  return texts;
}

/** A number of a file, by its table and key, and where it stands. */
struct Number {
  std::string key;
  std::uint32_t line = 0;
  std::size_t at = 0;
  std::size_t length = 0;
};

/** Tables and keys of nudge, move and draping end there: what follows is the name of an axis. */
std::string without_axis(const std::string& key) {
  static const std::regex travel("^(home_step\\.nudge|home_step\\.move|draping)\\..*");
  return std::regex_replace(key, travel, "$1");
}

/** Of a file without comments behind values, and without a number in a text. */
std::vector<Number> numbers_of(const std::string& text) {
  static const std::regex header(R"(^\[+([a-z_.]+)\]+)");
  static const std::regex token(R"(([a-z][a-z0-9_]*) = |(\})|"[^"]*"|#.*|(-?[0-9][0-9A-Fa-fx.e+-]*))");
  std::vector<Number> numbers;
  std::string table;
  std::uint32_t line = 0;
  std::size_t start = 0;
  std::istringstream lines(text);
  for (std::string each; std::getline(lines, each); start += each.size() + 1) {
    ++line;
    std::smatch found;
    if (std::regex_search(each, found, header)) {
      table = found[1].str() + '.';
      continue;
    }
    std::vector<std::string> keys;
    for (std::sregex_iterator match(each.begin(), each.end(), token), end; match != end; ++match) {
      const std::smatch& part = *match;
      if (part[1].matched) {
        // The first is the line's; every other one is in its inline table.
        keys.resize(std::min<std::size_t>(keys.size(), 1));
        keys.push_back(part[1].str());
      } else if (part[3].matched) {
        const std::string inner = keys.size() > 1 ? '.' + keys[1] : "";
        numbers.push_back({without_axis(table + keys.at(0) + inner), line,
                           start + static_cast<std::size_t>(part.position()),
                           static_cast<std::size_t>(part.length())});
      }
    }
  }
  return numbers;
}

std::optional<RobotError> refusal(const std::string& text) {
  const auto robot = parse_robot(text, "robot.toml");
  if (!robot) {
    return robot.error();
  }
  const auto compiled = compile(*robot);
  return compiled ? std::nullopt : std::optional(compiled.error());
}

TEST(ImpossibleNumbers, of_every_key_are_known) {
  std::set<std::string> keys;
  for (const std::string& text : robots()) {
    EXPECT_FALSE(refusal(text));
    for (const Number& number : numbers_of(text)) {
      keys.insert(number.key);
    }
  }
  for (const std::string& key : keys) {
    EXPECT_TRUE(impossible.contains(key)) << key;
  }
  for (const auto& [key, values] : impossible) {
    EXPECT_TRUE(keys.contains(key)) << key;
  }
}

TEST(ImpossibleNumbers, are_refused_where_they_stand) {
  std::map<std::string, std::pair<const std::string*, std::uint32_t>> first;
  for (const std::string& text : robots()) {
    for (const Number& number : numbers_of(text)) {
      const auto place = std::pair(&text, number.line);
      if (first.try_emplace(number.key, place).first->second != place) {
        continue;
      }
      std::vector<std::string> values = impossible.at(number.key);
      values.insert(values.end(), {"1e300", "-1e300", "nan", "inf", "9223372036854775807"});
      for (const std::string& value : values) {
        std::string edited = text;
        edited.replace(number.at, number.length, value);
        const std::optional<RobotError> refused = refusal(edited);
        const std::string what = number.key + " = " + value;
        EXPECT_TRUE(refused) << what << " is accepted";
        if (refused) {
          EXPECT_TRUE(refused->line == number.line || judged_with_others.contains(number.key))
              << what << ": " << refused->message();
          EXPECT_FALSE(refused->expected.empty()) << what;
        }
      }
    }
  }
}

}  // namespace
}  // namespace interlock
