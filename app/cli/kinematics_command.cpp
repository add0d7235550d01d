#include "cli/kinematics_command.hpp"

#include <algorithm>
#include <charconv>
#include <span>
#include <string_view>

#include "cli/named_robot.hpp"

namespace interlock::cli {

namespace {

/** One number or point of the robot file that the command line may replace. */
struct Setting {
  std::string_view key;
  std::span<double> numbers;
};

std::span<double> one(double& number) { return {&number, 1}; }

std::vector<Setting> settings_of(NeuroRcm& geometry) {
  return {{"side_link_mm", one(geometry.side_link_mm)},
          {"top_width_mm", one(geometry.top_width_mm)},
          {"home_separation_mm", one(geometry.home_separation_mm)},
          {"driver_to_rcm_mm", one(geometry.driver_to_rcm_mm)},
          {"home_rcm_mm", geometry.home_rcm_mm},
          {"min_separation_mm", one(geometry.min_separation_mm)},
          {"max_separation_mm", one(geometry.max_separation_mm)}};
}

std::vector<Setting> settings_of(ProstateTrapezoids& geometry) {
  return {{"side_link_mm", one(geometry.side_link_mm)},
          {"top_width_mm", one(geometry.top_width_mm)},
          {"lower_height_mm", one(geometry.lower_height_mm)},
          {"upper_height_mm", one(geometry.upper_height_mm)},
          {"stage_distance_mm", one(geometry.stage_distance_mm)},
          {"needle_tip_mm", one(geometry.needle_tip_mm)},
          {"front_pivot_offset_mm", one(geometry.front_pivot_offset_mm)},
          {"needle_height_mm", one(geometry.needle_height_mm)},
          {"needle_guide_mm", one(geometry.needle_guide_mm)},
          {"base_to_zframe_mm", geometry.base_to_zframe_mm},
          {"max_separation_mm", one(geometry.max_separation_mm)},
          {"max_angulation_rad", one(geometry.max_angulation_rad)}};
}

std::vector<Setting> settings_of(Robot& robot) {
  std::vector<Setting> settings =
      std::visit([](auto& geometry) { return settings_of(geometry); }, robot.kinematics);
  settings.insert(settings.end(),
                  {{"treatment_to_tip_mm", one(robot.probe.treatment_to_tip_mm)},
                   {"robot_to_entry_mm", one(robot.probe.robot_to_entry_mm)},
                   {"cannula_to_treatment_mm", one(robot.probe.cannula_to_treatment_mm)},
                   {"treatment_to_robot_at_home_mm", one(robot.probe.treatment_to_robot_at_home_mm)}});
  return settings;
}

/** Reads exactly as many numbers as there are places, with commas between them. */
bool read_numbers(std::string_view text, std::span<double> numbers) {
  const char* next = text.data();
  const char* const end = next + text.size();
  for (std::size_t index = 0; index < numbers.size(); ++index) {
    if (index > 0 && (next == end || *next++ != ',')) {
      return false;
    }
    const std::from_chars_result read = std::from_chars(next, end, numbers[index]);
    if (read.ec != std::errc{}) {
      return false;
    }
    next = read.ptr;
  }
  return next == end;
}

std::string keys_of(const std::vector<Setting>& settings) {
  std::string keys;
  for (const Setting& setting : settings) {
    keys += (keys.empty() ? "" : ", ") + std::string(setting.key);
  }
  return keys;
}

Result<void> change(Robot& robot, std::string_view assignment) {
  const std::vector<Setting> settings = settings_of(robot);
  const std::size_t sign = assignment.find('=');
  const auto setting = std::ranges::find(settings, assignment.substr(0, sign), &Setting::key);
  const std::string place = "--set " + std::string(assignment) + ": ";
  if (sign == std::string_view::npos || setting == settings.end()) {
    return failed(ExitCode::usage, place + "expected KEY=VALUE with one of the keys of " + robot.name + ": " +
                                       keys_of(settings));
  }
  if (!read_numbers(assignment.substr(sign + 1), setting->numbers)) {
    return failed(ExitCode::usage, place + (setting->numbers.size() == 1 ? "expected a number"
                                                                         : "expected three numbers: X,Y,Z"));
  }
  return {};
}

Result<Robot> load(const KinematicsOptions& options, const Installation& installation) {
  Result<Robot> robot = named_robot(options.robot, installation);
  if (!robot) {
    return robot;
  }
  for (const std::string& assignment : options.settings) {
    const Result<void> changed = change(*robot, assignment);
    if (!changed) {
      return tl::unexpected(changed.error());
    }
  }
  return robot;
}

}  // namespace

Result<void> answer_kinematics(KinematicsTask task, const KinematicsOptions& options,
                               const Installation& installation, std::istream& input, std::ostream& output) {
  const Result<Robot> robot = load(options, installation);
  if (!robot) {
    return tl::unexpected(robot.error());
  }
  const KinematicsResult<KinematicsLines> lines = KinematicsLines::create(*robot, task);
  if (!lines) {
    return failed(ExitCode::refused, robot->name + ": [kinematics]: " + lines.error().message());
  }
  std::size_t number = 0;
  std::size_t refused = 0;
  std::size_t first_refused = 0;
  for (std::string line; output && std::getline(input, line);) {
    ++number;
    const KinematicsLines::Answer answer = lines->answer(line, number);
    output << answer.text << std::endl;
    if (!answer.solved && ++refused == 1) {
      first_refused = number;
    }
  }
  if (!output) {
    return failed(ExitCode::precondition,
                  "the output was closed or is full, at line " + std::to_string(number));
  }
  if (refused > 0) {
    return failed(ExitCode::refused, std::to_string(refused) + " of " + std::to_string(number) +
                                         " lines have no answer, the first is line " +
                                         std::to_string(first_refused) + "; the output says why");
  }
  return {};
}

}  // namespace interlock::cli
