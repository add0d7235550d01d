#include <charconv>
#include <string_view>
#include <vector>

#include "cli/commands.hpp"
#include "cli/named_robot.hpp"

namespace interlock::cli {

namespace {

/** KEY=VALUE, where the value is a number or numbers with commas between them. */
Result<RobotSetting> setting_of(std::string_view assignment) {
  const std::size_t sign = assignment.find('=');
  RobotSetting setting{std::string(assignment.substr(0, sign)), {}};
  std::string_view rest = sign == std::string_view::npos ? "" : assignment.substr(sign);
  while (!rest.empty()) {
    rest.remove_prefix(1);
    const auto read = std::from_chars(rest.data(), rest.data() + rest.size(), setting.numbers.emplace_back());
    rest.remove_prefix(static_cast<std::size_t>(read.ptr - rest.data()));
    if (read.ec != std::errc{} || !(rest.empty() || rest.front() == ',')) {
      setting.numbers.clear();
      break;
    }
  }
  if (setting.key.empty() || setting.numbers.empty()) {
    return failed(ExitCode::usage,
                  "--set " + std::string(assignment) + ": expected KEY=NUMBER, or KEY=X,Y,Z for a point");
  }
  return setting;
}

Result<Robot> load(const KinematicsOptions& options, const Installation& installation) {
  std::vector<RobotSetting> settings;
  for (const std::string& assignment : options.settings) {
    const Result<RobotSetting> setting = setting_of(assignment);
    if (!setting) {
      return tl::unexpected(setting.error());
    }
    settings.push_back(*setting);
  }
  return named_robot(options.robot, installation, settings);
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
    return failed(ExitCode::refused, robot->name + ": " + lines.error().message());
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
