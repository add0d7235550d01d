#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/named_robot.hpp"
#include "cli/write_file.hpp"
#include "plant/parameters_file.hpp"
#include "robot/compile.hpp"
#include "tuning/step_run.hpp"

namespace interlock::cli {
namespace {

Result<ilk_config_t> compiled(const Robot& robot) {
  return compile(robot).map_error(
      [](const RobotError& error) { return Failure{ExitCode::refused, error.message()}; });
}

Result<plant::Parameters> parameters(const TuneOptions& options, const Robot& robot,
                                     const ilk_config_t& config, const Installation& installation) {
  const Result<std::filesystem::path> file =
      options.plant.empty() ? installation.plant(robot.name) : options.plant;
  if (!file) {
    return tl::unexpected(file.error());
  }
  return plant::load_parameters(*file, config).map_error([](const std::string& error) {
    return Failure{ExitCode::refused, error};
  });
}

Result<StepRun> run_of(const TuneOptions& options, const Robot& robot, const Installation& installation) {
  return compiled(robot).and_then([&](const ilk_config_t& config) {
    return parameters(options, robot, config, installation).and_then([&](const plant::Parameters& plant) {
      return run_step(robot, config, plant, options.step).map_error([](const std::string& error) {
        return Failure{ExitCode::refused, error};
      });
    });
  });
}

nlohmann::ordered_json to_json(const Robot& robot, const StepRun& run) {
  const StepFigures figures = figures_of(run);
  return {{"robot", robot.name},
          {"axis", run.axis},
          {"from_counts", run.from_counts},
          {"target_counts", run.target_counts},
          {"peak_counts_per_s", run.peak_counts_per_s},
          {"duration_s", run.duration_s},
          {"rms_velocity_error_percent", figures.rms_velocity_error_percent},
          {"largest_position_error_counts", figures.largest_position_error_counts},
          {"final_error_counts", figures.final_error_counts},
          {"overshoot_counts", figures.overshoot_counts},
          {"settle_ms",
           figures.settle_ms ? nlohmann::ordered_json(*figures.settle_ms) : nlohmann::ordered_json()}};
}

}  // namespace

Result<void> tune(const TuneOptions& options, const Installation& installation, std::ostream& output) {
  const Result<Robot> robot = named_robot(options.robot, installation);
  if (!robot) {
    return tl::unexpected(robot.error());
  }
  return run_of(options, *robot, installation).and_then([&](const StepRun& run) {
    const std::string title = robot->title + ": " + robot->find(run.axis)->title + ", " +
                              std::to_string(run.from_counts) + " to " + std::to_string(run.target_counts) +
                              " counts";
    return write_file(options.csv, step_csv(run))
        .and_then([&] { return write_file(options.svg, step_svg(run, title)); })
        .map([&] { output << to_json(*robot, run).dump() << '\n'; });
  });
}

}  // namespace interlock::cli
