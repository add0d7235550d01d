// The thesis' targeting workflow on the simulated hardware, unattended. docs/demo.md tells what it shows.
#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/exit_code.hpp"
#include "cli/installation.hpp"
#include "cli/named_robot.hpp"
#include "cli/write_file.hpp"
#include "plant/parameters_file.hpp"
#include "robot/compile.hpp"
#include "targeting_demo.hpp"

namespace interlock::cli {
namespace {

using nlohmann::ordered_json;

struct StudyOptions {
  std::string robot;           /**< name of a robot, or its file */
  std::string true_robot;      /**< whose kinematics are true; empty: the robot's */
  std::filesystem::path plant; /**< empty: the robot's */
  DemoOptions demo;
  std::filesystem::path csv;  /**< where the trials go; empty: nowhere */
  std::filesystem::path plot; /**< folder for the motions of the first round; empty: none */
  bool json = false;          /**< answer for programs */
};

Failure refusal(const std::string& text) { return {ExitCode::refused, text}; }

std::array<double, 3> numbers(const Eigen::Vector3d& point) { return {point.x(), point.y(), point.z()}; }

ordered_json to_json(const std::optional<DemoAblation>& ablation) {
  return ablation ? ordered_json{{"steps", ablation->steps}, {"time_s", ablation->time_s}} : ordered_json();
}

ordered_json to_json(const std::optional<NeedleInsertion>& biopsy) {
  if (!biopsy) {
    return {};
  }
  return {{"depth_mm", biopsy->depth_mm},
          {"punctures_mm", biopsy->punctures_mm},
          {"found_mm", biopsy->found_mm},
          {"images", biopsy->images}};
}

ordered_json to_json(const DemoTrial& trial) {
  ordered_json json{{"target", trial.target},
                    {"desired_mm", numbers(trial.desired)},
                    {"thesis_error_mm", numbers(trial.thesis_error)},
                    {"refused", trial.refused.empty() ? ordered_json() : ordered_json(trial.refused)}};
  if (trial.refused.empty()) {
    json["insertions"] = trial.reached.size();
    json["reached_mm"] = numbers(trial.reached.back());
    json["error_mm"] = numbers(trial.error());
    json["first_error_mm"] = numbers(trial.first_error());
    json["time_s"] = trial.time_s;
    json["ablation"] = to_json(trial.ablation);
    json["biopsy"] = to_json(trial.biopsy);
    json["claimed_mm"] = trial.claimed_mm;
    json["within_claim"] = trial.within_claim;
  }
  return json;
}

ordered_json to_json(const ErrorDistribution& distribution) {
  return {
      {"insertions", distribution.insertions}, {"mean_absolute_mm", numbers(distribution.mean_absolute_mm)},
      {"mean_mm", distribution.mean_mm},       {"median_mm", distribution.median_mm},
      {"p95_mm", distribution.p95_mm},         {"worst_mm", distribution.worst_mm}};
}

ordered_json to_json(const Robot& robot, const std::vector<Tracking>& tracking) {
  ordered_json axes = ordered_json::object();
  for (std::size_t place = 0; place < tracking.size(); ++place) {
    const Tracking& axis = tracking[place];
    if (axis.samples > 0) {
      axes[robot.axes[place].name] = {
          {"rms_counts", std::sqrt(axis.squares / static_cast<double>(axis.samples))},
          {"worst_counts", axis.worst_counts}};
    }
  }
  return axes;
}

ordered_json to_json(const Robot& robot, const DemoOptions& options, const DemoReport& report) {
  const ThesisTable& table = thesis_table(robot);
  ordered_json trials = ordered_json::array();
  for (const DemoTrial& trial : report.trials) {
    trials.push_back(to_json(trial));
  }
  return {{"robot", robot.name},
          {"seed", options.seed},
          {"table", table.title},
          {"mapping", table.mapping},
          {"trials", std::move(trials)},
          {"tolerance_mm", options.tolerance_mm},
          {"homing_counts", report.homing_counts},
          {"tracking", to_json(robot, report.tracking)},
          {"distributions",
           {{"first_scan", to_json(report.first_scan)},
            {"last_scan", to_json(report.last_scan)},
            {"thesis", to_json(report.thesis)}}},
          {"random",
           {{"tried", report.random.tried},
            {"refused", report.random.refused},
            {"rms_mm", report.random.rms_mm},
            {"worst_mm", report.random.worst_mm}}}};
}

std::string three(const Eigen::Vector3d& point, const char* format) {
  char text[80];
  std::snprintf(text, sizeof text, format, point.x(), point.y(), point.z());
  return text;
}

std::string row_of(const char* name, const ErrorDistribution& distribution) {
  std::ostringstream text;
  text << std::left << std::setw(12) << name << std::right << std::setw(10) << distribution.insertions
       << "   " << three(distribution.mean_absolute_mm, "%7.3f %7.3f %7.3f") << std::fixed
       << std::setprecision(3);
  for (const double figure :
       {distribution.mean_mm, distribution.median_mm, distribution.p95_mm, distribution.worst_mm}) {
    text << std::setw(9) << figure;
  }
  return text.str() + '\n';
}

/** What was done at a target besides reaching it. */
std::string treatment_of(const DemoTrial& trial) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1);
  if (trial.ablation) {
    text << "target " << trial.target << ": ablated at " << trial.ablation->steps
         << " angles and depths within " << trial.ablation->time_s << " s\n";
  }
  if (trial.biopsy) {
    text << "target " << trial.target << ": needle pushed " << trial.biopsy->depth_mm << " mm deep, "
         << trial.biopsy->found_mm.size() << " of " << trial.biopsy->punctures_mm.size()
         << " punctures noticed, " << trial.biopsy->images << " images taken\n";
  }
  return text.str();
}

std::string text_of(const Robot& robot, const DemoReport& report) {
  const ThesisTable& table = thesis_table(robot);
  std::ostringstream text;
  text << table.title << ": " << table.mapping << ".\n\n"
       << "target  desired (RAS, mm)             reached                       error                   "
          "insertions  thesis' error\n";
  for (const DemoTrial& trial : report.trials) {
    text << std::left << std::setw(8) << trial.target << three(trial.desired, "%9.3f %9.3f %9.3f ");
    if (trial.refused.empty()) {
      text << three(trial.reached.back(), "%9.3f %9.3f %9.3f ") << three(trial.error(), "%7.3f %7.3f %7.3f ")
           << std::setw(12) << trial.reached.size() << three(trial.thesis_error, "%7.3f %7.3f %7.3f") << '\n';
    } else {
      text << "refused: " << trial.refused << '\n';
    }
  }
  text << '\n';
  for (const DemoTrial& trial : report.trials) {
    text << treatment_of(trial);
  }
  text << "\nerrors (mm)       count   of each axis of the table     mean   median      p95    worst\n"
       << row_of("first scan", report.first_scan) << row_of("last scan", report.last_scan)
       << row_of("thesis", report.thesis);
  char random[160];
  std::snprintf(
      random, sizeof random,
      "\n%zu random targets: %zu refused, the others reached within %.4f mm RMS, %.4f mm at worst, by whole "
      "counts\n",
      report.random.tried, report.random.refused, report.random.rms_mm, report.random.worst_mm);
  text << random;
  return text.str();
}

std::string csv_of(const DemoReport& report) {
  std::ostringstream text;
  text << "target,insertions,first_error_r_mm,first_error_a_mm,first_error_s_mm,desired_r_mm,desired_a_mm,"
          "desired_s_mm,reached_r_mm,reached_a_mm,reached_s_mm,error_r_mm,"
          "error_a_mm,"
          "error_s_mm,thesis_error_1_mm,thesis_error_2_mm,thesis_error_3_mm,time_s\n";
  for (const DemoTrial& trial : report.trials) {
    if (trial.refused.empty()) {
      text << trial.target << ',' << trial.reached.size() << ','
           << three(trial.first_error(), "%.4f,%.4f,%.4f,") << three(trial.desired, "%.4f,%.4f,%.4f,")
           << three(trial.reached.back(), "%.4f,%.4f,%.4f,") << three(trial.error(), "%.4f,%.4f,%.4f,")
           << three(trial.thesis_error, "%.4f,%.4f,%.4f,") << trial.time_s << '\n';
    }
  }
  return text.str();
}

/** Drawing and table of each axis that the motion moved; nothing when `folder` is empty. */
Result<void> plot(const std::filesystem::path& folder, const Robot& robot, const std::string& name,
                  const MotionRecord& record) {
  Result<void> written;
  for (std::size_t axis = 0; axis < robot.axes.size() && !folder.empty(); ++axis) {
    if (!record.moved(axis)) {
      continue;
    }
    const Axis& shown = robot.axes[axis];
    const std::string file = name + "-" + shown.name;
    const std::string title = robot.title + ": " + name + ", " + shown.title;
    written =
        written
            .and_then(
                [&] { return write_file(folder / (file + ".svg"), motion_svg(record, axis, shown, title)); })
            .and_then([&] { return write_file(folder / (file + ".csv"), motion_csv(record, axis, shown)); });
  }
  return written;
}

/** The folder exists then, unless its name is empty. */
Result<void> make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  if (!folder.empty() && !std::filesystem::is_directory(folder) &&
      !std::filesystem::create_directories(folder, error)) {
    return tl::unexpected(
        Failure{ExitCode::precondition, folder.string() + " cannot be made: " + error.message()});
  }
  return {};
}

Result<DemoReport> report_of(const StudyOptions& options, const DemoOptions& demo, const Robot& robot,
                             const Installation& installation) {
  const auto config = compile(robot);
  if (!config) {
    return tl::unexpected(refusal(config.error().message()));
  }
  const Result<std::filesystem::path> plant_file =
      options.plant.empty() ? installation.plant(robot.name) : options.plant;
  return plant_file.and_then([&](const std::filesystem::path& file) {
    return plant::load_parameters(file, *config)
        .map_error(refusal)
        .and_then([&](const plant::Parameters& plant) {
          Result<void> plotted;
          const DemoAudience audience{
              [&](const std::string& what) { std::cerr << "thesis_study: " << what << std::endl; },
              [&](const std::string& name, const MotionRecord& record) {
                plotted = plotted.and_then([&] { return plot(options.plot, robot, name, record); });
              }};
          return run_demo(robot, plant, demo, audience).map_error(refusal).and_then([&](DemoReport report) {
            return plotted.map([&] { return std::move(report); });
          });
        });
  });
}

/** Runs the experiments and shows each target's desired and reached position and error beside the thesis'. */
Result<void> study(const StudyOptions& options) {
  const Installation installation = Installation::current();
  const Result<Robot> robot = named_robot(options.robot, installation);
  if (!robot) {
    return tl::unexpected(robot.error());
  }
  DemoOptions demo = options.demo;
  if (!options.true_robot.empty()) {
    const Result<Robot> true_robot = named_robot(options.true_robot, installation);
    if (!true_robot) {
      return tl::unexpected(true_robot.error());
    }
    demo.true_robot = *true_robot;
  }
  return make_folder(options.plot)
      .and_then([&] { return report_of(options, demo, *robot, installation); })
      .and_then([&](const DemoReport& report) {
        return write_file(options.csv, csv_of(report)).map([&] {
          std::cout << (options.json ? to_json(*robot, options.demo, report).dump() + '\n'
                                     : text_of(*robot, report));
        });
      });
}

int main(int argc, char** argv) {
  StudyOptions options;
  CLI::App cli("Run the thesis' targeting workflow on the simulated hardware, and show how near it came",
               "thesis_study");
  cli.add_option("ROBOT", options.robot, "neuro, prostate, or a robot's file")->required();
  cli.add_option("--seed", options.demo.seed, "Of registration, plant and random targets")
      ->capture_default_str();
  cli.add_option("--random-targets", options.demo.random_targets, "Targets that are only computed")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  cli.add_option("--rounds", options.demo.rounds,
                 "How often each target of the table is visited; 0: the robot homes only")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  cli.add_option("--tolerance", options.demo.tolerance_mm, "Distance from the target that may stay, mm")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  cli.add_option("--plant", options.plant, "The simulated robot: its motors, play, noise")
      ->check(CLI::ExistingFile);
  cli.add_option("--true-robot", options.true_robot, "Robot whose kinematics are the true ones");
  cli.add_option("--fiducials", options.demo.fiducial_sd_mm,
                 "Deviation of where fiducials are seen, mm: each round registers anew")
      ->check(CLI::Range(0.0, 10.0));
  cli.add_flag("--scattered", options.demo.scattered,
               "Axes with a switch start anywhere in the half of their range before it");
  cli.add_flag("--targeting-only", options.demo.targeting_only,
               "Neither ablate nor have a hand push the needle: the thesis' tables");
  cli.add_option("--dwell", options.demo.dwell_s, "Rest at each angle and depth of an ablation, s")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  cli.add_option("--csv", options.csv, "Where the table of the targets goes");
  cli.add_option("--plot", options.plot,
                 "Folder for position, velocity and error of each axis, as drawings and tables");
  cli.add_flag("--json", options.json, "One JSON object");
  try {
    cli.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return cli.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::usage);
  }
  const Result<void> done = study(options);
  if (!done) {
    std::cerr << "thesis_study: " << done.error().text << '\n';
    return static_cast<int>(done.error().code);
  }
  return 0;
}

}  // namespace
}  // namespace interlock::cli

int main(int argc, char** argv) {
  try {
    return interlock::cli::main(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "thesis_study: " << error.what() << '\n';
    return static_cast<int>(interlock::cli::ExitCode::precondition);
  }
}
