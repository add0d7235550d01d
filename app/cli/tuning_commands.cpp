#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/named_robot.hpp"
#include "cli/write_file.hpp"
#include "plant/parameters_file.hpp"
#include "robot/compile.hpp"
#include "tuning/gain_search.hpp"
#include "tuning/identification.hpp"
#include "tuning/step_run.hpp"

namespace interlock::cli {
namespace {

using Json = nlohmann::ordered_json;

Failure simulation_refused(const std::string& why) { return {ExitCode::refused, why}; }

/** A file that is read is overwritten by no other: only `write` may be the robot's own. */
Result<void> spares(const SimulatedAxis& options, const std::filesystem::path& csv,
                    const std::filesystem::path& robot, const std::filesystem::path& plant) {
  const auto refuse = [](const std::filesystem::path& file) {
    return failed(ExitCode::usage,
                  file.string() + " would be overwritten by another file; choose another name");
  };
  for (const std::filesystem::path& drawn : {options.svg, csv}) {
    if (is_same_file(drawn, robot) || is_same_file(drawn, plant) || is_same_file(drawn, options.write)) {
      return refuse(drawn);
    }
  }
  if (is_same_file(options.svg, csv)) {
    return refuse(csv);
  }
  return is_same_file(options.write, plant) ? refuse(plant) : Result<void>();
}

/** A robot, as the kernel takes it, on its simulated hardware. */
struct Simulated {
  std::filesystem::path file;
  Robot robot;
  ilk_config_t config;
  plant::Parameters plant;
};

Result<Simulated> simulated(const SimulatedAxis& options, const std::filesystem::path& csv,
                            const Installation& installation) {
  Simulated made{};
  return installation.robot(options.robot)
      .and_then([&](const std::filesystem::path& file) {
        made.file = file;
        return load_robot(file).map_error(robot_failure);
      })
      .and_then([&](const Robot& robot) {
        made.robot = robot;
        return compile(robot).map_error(robot_failure);
      })
      .and_then([&](const ilk_config_t& config) {
        made.config = config;
        return options.plant.empty() ? installation.plant(made.robot.name) : options.plant;
      })
      .and_then([&](const std::filesystem::path& file) {
        return spares(options, csv, made.file, file).and_then([&] {
          return plant::load_parameters(file, made.config).map_error(simulation_refused);
        });
      })
      .map([&](const plant::Parameters& parameters) {
        made.plant = parameters;
        return made;
      });
}

std::string title_of(const Simulated& on, const std::string& axis) {
  return on.robot.title + ": " + on.robot.find(axis)->title;
}

/** Writes the robot's file with the changes, unless the kernel would refuse it. */
Result<void> write_robot(const std::filesystem::path& to, const Simulated& on, const std::string& axis,
                         const std::vector<NumberChange>& changes) {
  if (to.empty()) {
    return {};
  }
  return changed_file(on.robot, to.string(), axis, changes)
      .map_error(robot_failure)
      .and_then([&](const std::string& edited) { return write_file(to, edited); });
}

Json optional_number(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

Json to_json(const StepRun& run) {
  const StepFigures figures = figures_of(run);
  return {{"from_counts", run.from_counts},
          {"target_counts", run.target_counts},
          {"peak_counts_per_s", run.peak_counts_per_s},
          {"duration_s", run.duration_s},
          {"rms_velocity_error_percent", figures.rms_velocity_error_percent},
          {"largest_position_error_counts", figures.largest_position_error_counts},
          {"final_error_counts", figures.final_error_counts},
          {"overshoot_counts", figures.overshoot_counts},
          {"settle_ms", optional_number(figures.settle_ms)}};
}

/** One line: robot and axis first. */
void answer(std::ostream& output, const Simulated& on, const std::string& axis, const Json& found) {
  Json line{{"robot", on.robot.name}, {"axis", axis}};
  line.update(found);
  output << line.dump() << '\n';
}

/** The best gains, where they are to be written. */
Result<std::optional<FoundGains>> searched(const TuneOptions& options, const Simulated& on) {
  if (options.write.empty()) {
    return std::nullopt;
  }
  return search_gains(on.robot, on.config, on.plant, options.step)
      .map_error(simulation_refused)
      .map([](const FoundGains& found) { return std::optional(found); });
}

std::vector<NumberChange> gain_changes(const Gains& found, const Gains& file) {
  std::vector<NumberChange> changes;
  const auto add = [&](const char* key, double is, double was) {
    if (is != was) {
      changes.push_back({{key, is}, was});
    }
  };
  add("gains.position_per_s", found.position_per_s, file.position_per_s);
  add("gains.velocity", found.velocity, file.velocity);
  add("gains.integral_per_s", found.integral_per_s, file.integral_per_s);
  return changes;
}

/** Figures and files of a step with the gains that were found, or else with those that were asked for. */
Result<Json> step_with(const TuneOptions& options, const Simulated& on,
                       const std::optional<FoundGains>& found) {
  StepOptions step = options.step;
  if (found) {
    step.gains = {found->gains.position_per_s, found->gains.velocity, found->gains.integral_per_s};
  }
  return run_step(on.robot, on.config, on.plant, step)
      .map_error(simulation_refused)
      .and_then([&](const StepRun& run) {
        const std::string title = title_of(on, run.axis) + ", " + std::to_string(run.from_counts) + " to " +
                                  std::to_string(run.target_counts) + " counts";
        return write_file(options.csv, step_csv(run))
            .and_then([&] { return write_file(options.svg, step_svg(run, title)); })
            .map([&] { return to_json(run); });
      });
}

}  // namespace

Result<void> tune(const TuneOptions& options, const Installation& installation, std::ostream& output) {
  return simulated(options, options.csv, installation).and_then([&](const Simulated& on) {
    return searched(options, on).and_then([&](const std::optional<FoundGains>& found) {
      return step_with(options, on, found).and_then([&](Json figures) {
        const std::string& axis = options.step.axis;
        std::vector<NumberChange> changes;
        if (found) {
          changes = gain_changes(found->gains, on.robot.find(axis)->gains);
          figures["worst_step_percent"] = {{"was", found->begun_with_percent},
                                           {"is", found->rms_velocity_error_percent}};
          figures["changes"] = interlock::to_json(changes);
        }
        return write_robot(options.write, on, axis, changes).map([&] { answer(output, on, axis, figures); });
      });
    });
  });
}

Result<void> identify(const IdentifyOptions& options, const Installation& installation,
                      std::ostream& output) {
  return simulated(options, {}, installation).and_then([&](const Simulated& on) {
    return interlock::identify(on.robot, on.config, on.plant, options.axis, options.seed)
        .map_error(simulation_refused)
        .and_then([&](const Identified& measured) {
          const auto changes = changes_of(on.robot, *on.robot.find(options.axis), measured);
          return write_file(options.svg, identified_svg(measured, title_of(on, options.axis)))
              .and_then([&]() -> Result<void> {
                return options.write.empty()
                           ? Result<void>()
                           : believable(on.robot, options.axis, measured).map_error(robot_failure);
              })
              .and_then([&] { return write_robot(options.write, on, options.axis, changes); })
              .map([&] {
                Json found = interlock::to_json(measured);
                found["changes"] = interlock::to_json(changes);
                answer(output, on, options.axis, found);
              });
        });
  });
}

}  // namespace interlock::cli
