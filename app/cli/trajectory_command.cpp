#include <nlohmann/json.hpp>
#include <string_view>

#include "cli/commands.hpp"
#include "cli/named_robot.hpp"
#include "cli/write_file.hpp"
#include "trajectory/trajectory_csv.hpp"

namespace interlock::cli {

using nlohmann::json;

namespace {

json to_json(const TimedTrajectory& trajectory) {
  json axes = json::object();
  for (const TrajectoryAxis& axis : trajectory.axes()) {
    axes[axis.name] = {{"unit", unit_name(axis.unit)},
                       {"lowest", axis.reach.lowest},
                       {"highest", axis.reach.highest},
                       {"top_speed", axis.top.velocity},
                       {"top_acceleration", axis.top.acceleration},
                       {"top_jerk", axis.top.jerk}};
  }
  return {{"rows", trajectory.rows()},
          {"duration_s", trajectory.duration_s()},
          {"slowed_by", trajectory.slowed_by()},
          {"axes", axes}};
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
  const Result<std::string> text = text_of_file(options.file, "a trajectory");
  if (!text) {
    return tl::unexpected(text.error());
  }
  const TrajectoryResult<TimedTrajectory> trajectory = read_trajectory(*text, *robot, options.timing);
  output << (trajectory ? to_json(*trajectory) : to_json(trajectory.error())).dump() << '\n';
  if (!trajectory) {
    return failed(ExitCode::refused, options.file.string() + ": " + trajectory.error().message());
  }
  return {};
}

}  // namespace interlock::cli
