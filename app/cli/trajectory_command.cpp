#include <array>
#include <charconv>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>

#include "cli/commands.hpp"
#include "cli/named_robot.hpp"
#include "trajectory/trajectory_csv.hpp"

namespace interlock::cli {

using nlohmann::json;

namespace {

Result<VelocityLimits> limits_of(const std::vector<std::string>& assignments) {
  VelocityLimits limits;
  for (const std::string& assignment : assignments) {
    const std::size_t sign = assignment.find('=');
    const char* const end = assignment.data() + assignment.size();
    double velocity = 0.0;
    const bool read = sign != std::string::npos && [&] {
      const auto [next, error] = std::from_chars(assignment.data() + sign + 1, end, velocity);
      return error == std::errc{} && next == end;
    }();
    if (!read || !limits.emplace(assignment.substr(0, sign), velocity).second) {
      return failed(ExitCode::usage, "--max-velocity " + assignment +
                                         ": expected AXIS=VALUE, once for an axis, in its unit per second");
    }
  }
  return limits;
}

/** The file's text; of one that is longer than a trajectory may be, enough to say so. */
Result<std::string> text_of(const std::filesystem::path& file) {
  std::ifstream input(file, std::ios::binary);
  if (!input || std::filesystem::is_directory(file)) {
    return failed(ExitCode::precondition,
                  file.string() + ": cannot be read; choose a file with a trajectory");
  }
  std::string text;
  std::array<char, 1 << 16> part{};
  while (input && text.size() <= most_trajectory_bytes) {
    input.read(part.data(), part.size());
    text.append(part.data(), static_cast<std::size_t>(input.gcount()));
  }
  return text;
}

json to_json(const TimedTrajectory& trajectory) {
  json axes = json::object();
  for (const TrajectoryAxis& axis : trajectory.axes()) {
    axes[axis.name] = {{"unit", unit_name(axis.unit)},
                       {"lowest", axis.reach.lowest},
                       {"highest", axis.reach.highest},
                       {"top_speed", axis.top_speed}};
  }
  return {{"rows", trajectory.rows()}, {"duration_s", trajectory.duration_s()}, {"axes", axes}};
}

json to_json(const TrajectoryError& error) {
  return {{"error",
           {{"code", code_name(error.code)},
            {"line", error.line == 0 ? json() : json(error.line)},
            {"column", error.column.empty() ? json() : json(error.column)},
            {"text", error.message()}}}};
}

}  // namespace

Result<void> check_trajectory(const TrajectoryOptions& options, const Installation& installation,
                              std::ostream& output) {
  const Result<Robot> robot = named_robot(options.robot, installation);
  if (!robot) {
    return tl::unexpected(robot.error());
  }
  const Result<VelocityLimits> limits = limits_of(options.max_velocities);
  if (!limits) {
    return tl::unexpected(limits.error());
  }
  const Result<std::string> text = text_of(options.file);
  if (!text) {
    return tl::unexpected(text.error());
  }
  const TrajectoryResult<TimedTrajectory> trajectory = read_trajectory(*text, *robot, *limits);
  output << (trajectory ? to_json(*trajectory) : to_json(trajectory.error())).dump() << '\n';
  if (!trajectory) {
    return failed(ExitCode::refused, options.file.string() + ": " + trajectory.error().message());
  }
  return {};
}

}  // namespace interlock::cli
