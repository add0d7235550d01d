/**
 * @file
 * `interlock`: the command line.
 */
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <exception>
#include <iostream>
#include <map>
#include <optional>

#include "build_info/build_info.hpp"
#include "cli/commands.hpp"
#include "cli/exit_code.hpp"
#include "cli/installation.hpp"
#include "cli/queued_output.hpp"
#include "cli/run_command.hpp"
#include "cli/store_command_line.hpp"
#include "robot/compile.hpp"

namespace interlock::cli {
namespace {

constexpr const char* footer =
    "Exit codes: 0 done; 1 refused: robot file, input line, trajectory, broken audit, rule of the store, "
    "message,\nrecording that differs or is damaged;\n"
    "2 command line not understood; 3 something stands in the way (busy port, second instance, missing "
    "file);\n"
    "4 kernel or simulator ended; 5 the app kept ending; 6 no answer.";

Result<void> show_version(const std::string& robot, std::ostream& output) {
  output << "interlock " << version() << ", commit " << commit() << '\n';
  if (robot.empty()) {
    return {};
  }
  const Result<std::filesystem::path> file = Installation::current().robot(robot);
  if (!file) {
    return tl::unexpected(file.error());
  }
  const Result<CompiledRobot> compiled = load_and_compile(*file);
  if (!compiled) {
    return tl::unexpected(compiled.error());
  }
  output << "configuration " << config_hash(compiled->config) << " of " << compiled->robot.name << '\n';
  return {};
}

/** The command line as it was given. */
struct CommandLine {
  bool version = false;
  std::string version_robot;
  RunOptions run;
  RecordOptions record;
  ReplayOptions replay;
  StatusOptions status;
  KinematicsOptions kinematics;
  TrajectoryOptions trajectory;
  TuneOptions tune;
  IdentifyOptions identify;
  CalibrateOptions calibrate;
  IgtlOptions igtl;
  std::filesystem::path model;
  bool model_json = false;
  std::filesystem::path config;
  StoreCommandLine store;
};

void add_run(CLI::App& cli, RunOptions& options) {
  CLI::App* const command = cli.add_subcommand("run", "Run a simulated robot with kernel, app and console");
  command->add_option("--robot", options.robot, "Name of a robot, or its file")->capture_default_str();
  command->add_option("--port", options.port, "Port of the console on 127.0.0.1; 0 takes one that is free")
      ->capture_default_str();
  command->add_option("--igtl-port", options.igtl_port,
                      "Port for OpenIGTLink, in place of the robot file's; 0 takes one that is free");
  command
      ->add_option("--igtl-dialect", options.igtl_dialect,
                   "Dialect of OpenIGTLink, in place of the robot file's: thesis, brp2013 or wpi2024")
      ->check(CLI::IsMember({"thesis", "brp2013", "wpi2024"}));
  const std::map<std::string, ClockChoice> clocks{{"paced", ClockChoice::paced}, {"sim", ClockChoice::sim}};
  CLI::Option* const clock =
      command
          ->add_option("--clock", options.clock,
                       "Simulated time. paced: follows the wall clock and waits when this machine is late; "
                       "sim: as fast as possible")
          ->transform(CLI::CheckedTransformer(clocks).description("{paced,sim}"))
          ->default_str("paced");
  CLI::Option* const realtime = command->add_flag_callback(
      "--realtime", [&options] { options.clock = ClockChoice::real; },
      "Wall-clock deadlines in place of simulated time, for benchmarks: a late machine is a fault");
  realtime->excludes(clock);
  command->add_option("--speed", options.speed, "Paced clock as a multiple of real time; default 1")
      ->check(CLI::Range(0.001, 1000.0))
      ->excludes(realtime);
  command->add_option("--seed", options.seed, "Seed of the simulated hardware");
  command->add_option("--core", options.core, "Core that the kernel has for itself; default: none");
  command->add_option("--state", options.state, "State directory; default $XDG_STATE_HOME/interlock/ROBOT");
  command->add_flag(
      "--new-store", options.new_store,
      "Begin a new store, without users, where the one of an earlier run is missing or damaged");
  command->add_option("--sockets", options.sockets, "Directory for the sockets; default: a private one");
  command->add_option("--public-origin", options.public_origin,
                      "https://NAME[:PORT] of the console behind a proxy with TLS on this machine");
  command->add_option("--trusted-proxy", options.trusted_proxy,
                      "Address that the proxy connects from; its X-Forwarded-For names the client");
  command->add_option("--plant", options.plant, "Parameters of the simulated hardware")
      ->check(CLI::ExistingFile);
  command->add_option("--web", options.web, "Directory of the built console")->check(CLI::ExistingDirectory);
  command->add_flag("--record", options.record,
                    "Record all of the run; without it, the minute around each lock and fault is");
  command
      ->add_option("--black-box-seconds", options.black_box_s,
                   "Time that the black box in memory holds; default 60")
      ->check(CLI::Range(1, 3600));
}

void add_record(CLI::App& cli, RecordOptions& options) {
  CLI::App* const command =
      cli.add_subcommand("record", "Write out what the black box of a running kernel holds");
  command->add_option("--robot", options.place.robot, "Name of a robot, or its file")->capture_default_str();
  command->add_option("--state", options.place.state,
                      "State directory; default $XDG_STATE_HOME/interlock/ROBOT");
  command->add_option("--black-box", options.black_box,
                      "Socket of a kernel that runs as a service, /run/interlock/black-box");
  command->add_option("--seconds", options.seconds, "Time that is wanted of it")
      ->check(CLI::Range(1, 3600))
      ->capture_default_str();
  command->add_option("-o,--output", options.file, "File to make; default: among the robot's recordings");
}

void add_replay(CLI::App& cli, ReplayOptions& options) {
  CLI::App* const command = cli.add_subcommand(
      "replay", "Run the kernel core again on a recording: identical, or the first bit that differs");
  command->add_option("FILE", options.file, "Recording")->required();
  command->add_option("--csv", options.csv, "File for a table, a row a tick");
  command->add_option("--plot", options.plot, "File for a plot of positions, drives and mode, as SVG");
  command->add_flag("--judge", options.judge,
                    "Have every monitor of the kernel's properties judge each tick; a broken one is refused");
  CLI::Option* const console = command->add_flag(
      "--console", options.console, "Show it in the console, at the pace at which it was recorded");
  command
      ->add_option("--robot", options.show.robot,
                   "Robot's name or file; default: the one whose configuration ran")
      ->needs(console);
  command->add_option("--port", options.show.port, "Port of the console; 0: any free one")
      ->needs(console)
      ->capture_default_str();
  command->add_option("--speed", options.show.speed, "Multiple of the recorded pace")
      ->needs(console)
      ->check(CLI::Range(0.01, 100.0))
      ->capture_default_str();
}

void add_status(CLI::App& cli, StatusOptions& options) {
  CLI::App* const command =
      cli.add_subcommand("status", "Show the state of the robot that runs on this machine");
  command->add_option("--port", options.port, "Port of the console")->capture_default_str();
  command->add_flag("--json", options.json, "The app's answer as it came");
}

void add_kinematics(CLI::App& cli, KinematicsOptions& options) {
  CLI::App* const command =
      cli.add_subcommand("kinematics", "Solve kinematics: a JSON object a line in, one out");
  command->require_subcommand(1);
  for (CLI::App* const task :
       {command->add_subcommand("fk", "Joints to the pose of the tool"),
        command->add_subcommand("ik", "Pose, or entry and target, to joints"),
        command->add_subcommand("align",
                                "Entry and target in the scanner to setpoints and what they reach")}) {
    task->add_option("--robot", options.robot, "Name of a robot, or its file")->required();
    task->add_option("--set", options.settings, "KEY=VALUE in place of the file's [kinematics] and [probe]");
  }
}

void add_trajectory(CLI::App& cli, TrajectoryOptions& options) {
  CLI::App* const command = cli.add_subcommand("trajectory", "Check a trajectory that is written in a file");
  command->require_subcommand(1);
  CLI::App* const check =
      command->add_subcommand("check", "Say whether a robot can follow it, in one JSON object");
  check->add_option("--robot", options.robot, "Name of a robot, or its file")->required();
  check->add_flag_callback(
      "--slow-to-fit", [&options] { options.timing = Timing::slowed_to_fit; },
      "Where an axis would go beyond its rates, make all times longer");
  check->add_option("FILE", options.file, "Trajectory: time [s],AXIS [UNIT],... and rows of numbers")
      ->required();
}

void add_simulated(CLI::App& command, SimulatedAxis& options, std::string& axis, std::uint64_t& seed,
                   const std::string& plotted, const std::string& written) {
  command.add_option("--robot", options.robot, "Name of a robot, or its file")->required();
  command.add_option("--axis", axis, "Name of the axis")->required();
  command.add_option("--seed", seed, "Seed of the plant's noise")->capture_default_str();
  command.add_option("--plant", options.plant, "Parameters of the simulated hardware")
      ->check(CLI::ExistingFile);
  command.add_option("--svg", options.svg, "File for the plot of " + plotted);
  command.add_option("--write", options.write, "File for the robot's file with " + written);
}

void add_identify(CLI::App& cli, IdentifyOptions& options) {
  CLI::App* const command = cli.add_subcommand(
      "identify",
      "Measure dead zone, speed, lag, coast, play and noise of an axis on the simulated hardware");
  add_simulated(*command, options, options.axis, options.seed, "speed over drive", "what was measured");
}

void add_calibrate(CLI::App& cli, CalibrateOptions& options) {
  CLI::App* const command =
      cli.add_subcommand("calibrate", "Fit a robot's kinematics to poses that were measured on it");
  command->add_option("--robot", options.robot, "Name of a robot, or its file")->required();
  command
      ->add_option("--poses", options.poses,
                   "Table: AXIS [UNIT],...,tool_x [mm],tool_y [mm],tool_z [mm] and a row a pose")
      ->required();
  command->add_flag("--in-zframe", options.fit.in_zframe,
                    "The poses are in the robot's zFrame; default: in a frame that is fitted with them");
  command->add_option("--sd-mm", options.fit.sd_mm, "Standard deviation of a measured point, each coordinate")
      ->check(CLI::PositiveNumber);
  command->add_option("--sd-rad", options.fit.sd_rad, "Standard deviation of a measured direction")
      ->check(CLI::PositiveNumber);
  command->add_option("--hold", options.fit.hold,
                      "Numbers to leave as they are, such as kinematics.side_link_mm");
  command->add_option("--leave-out", options.leave_out, "Lines of the table that do not count");
  command->add_option("--write", options.write, "File for the robot's file with what was found");
}

void add_tune(CLI::App& cli, TuneOptions& options) {
  CLI::App* const command =
      cli.add_subcommand("tune", "Run a step of an axis on the simulated hardware and say how good it was");
  add_simulated(*command, options, options.step.axis, options.step.seed,
                "position, velocity and control output", "the best gains that a search finds");
  command->add_option("--move", options.step.move_counts,
                      "Counts from where it stands; default: what full speed makes in 0.6 s, or half of its "
                      "way, away from the switch");
  command->add_option("--cruise", options.step.cruise_counts_per_s,
                      "Speed of the profile in counts/s; default: five sixths of full speed");
  command->add_option("--full-speed", options.step.full_speed_counts_per_s,
                      "Speed at full drive that the controller believes in; default: that of the plant");
  AskedGains& gains = options.step.gains;
  command->add_option(
      "--position-gain", gains.position_per_s,
      "Velocity for a count of position error, 1/s; default, as of the others: the robot file's");
  command->add_option("--velocity-gain", gains.velocity, "Output for a velocity error, no unit");
  command->add_option("--integral-gain", gains.integral_per_s, "Growth of the output, 1/s");
  command->add_option("--late", options.step.late_ticks, "Ticks by which each move reaches the kernel late")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  command->add_option("--csv", options.csv, "File for the table, a row a tick");
}

void add_model(CLI::App& cli, CommandLine& line) {
  CLI::App* const model = cli.add_subcommand("model", "Check or compile a robot file");
  model->require_subcommand(1);
  CLI::App* const check = model->add_subcommand("check", "Say whether the kernel will accept the robot");
  check->add_option("FILE", line.model, "Robot file")->required();
  check->add_flag("--json", line.model_json, "Answer in one JSON object");
  CLI::App* const compile = model->add_subcommand("compile", "Write the kernel's binary configuration");
  compile->add_option("FILE", line.model, "Robot file")->required();
  compile->add_option("-o,--output", line.config, "Configuration file; default ROBOT.ilkc");
}

KinematicsTask task_of(const CLI::App& kinematics) {
  if (kinematics.got_subcommand("align")) {
    return KinematicsTask::alignment;
  }
  return kinematics.got_subcommand("fk") ? KinematicsTask::forward : KinematicsTask::inverse;
}

Result<void> execute(const CLI::App& cli, const CommandLine& line) {
  if (line.version) {
    return show_version(line.version_robot, std::cout);
  }
  if (cli.got_subcommand("run")) {
    if (line.run.speed && line.run.clock == ClockChoice::sim) {
      return failed(ExitCode::usage, "--speed applies to the paced clock; leave it or --clock sim out");
    }
    QueuedOutput output(STDOUT_FILENO);
    return run(line.run, Installation::current(), output.stream());
  }
  if (cli.got_subcommand("status")) {
    return show_status(line.status, std::cout);
  }
  if (cli.got_subcommand("record")) {
    return record(line.record, Installation::current(), std::cout);
  }
  if (cli.got_subcommand("replay")) {
    return replay(line.replay, std::cout);
  }
  if (line.store.chosen()) {
    return line.store.execute(Installation::current(), std::cout);
  }
  if (const CLI::App& kinematics = *cli.get_subcommand("kinematics"); kinematics.parsed()) {
    return answer_kinematics(task_of(kinematics), line.kinematics, Installation::current(), std::cin,
                             std::cout);
  }
  if (cli.got_subcommand("trajectory")) {
    return check_trajectory(line.trajectory, Installation::current(), std::cout);
  }
  if (cli.got_subcommand("identify")) {
    return identify(line.identify, Installation::current(), std::cout);
  }
  if (cli.got_subcommand("calibrate")) {
    return calibrate(line.calibrate, Installation::current(), std::cout);
  }
  if (cli.got_subcommand("tune")) {
    return tune(line.tune, Installation::current(), std::cout);
  }
  if (const CLI::App& igtl = *cli.get_subcommand("igtl"); igtl.parsed()) {
    return speak_igtl(igtl, line.igtl, std::cout);
  }
  const CLI::App& model = *cli.get_subcommand("model");
  return model.got_subcommand("check") ? check_model(line.model, line.model_json, std::cout)
                                       : compile_model(line.model, line.config, std::cout);
}

int report(ExitCode code, const std::string& text) {
  std::cout.flush();
  QueuedOutput errors(STDERR_FILENO);
  errors.stream() << "interlock: " << text << '\n';
  return static_cast<int>(code);
}

int main(int argc, char** argv) {
  // A closed terminal must not end the supervisor before it has stopped its children.
  std::signal(SIGPIPE, SIG_IGN);
  CommandLine line;
  CLI::App cli("Interlock: control software for MRI-compatible surgical robots", "interlock");
  cli.footer(footer);
  cli.add_flag("--version", line.version, "Version and commit; with --robot, its configuration's hash");
  cli.add_option("--robot", line.version_robot, "Name of a robot, or its file, for --version");
  cli.require_subcommand(0, 1);
  add_run(cli, line.run);
  add_status(cli, line.status);
  add_record(cli, line.record);
  add_replay(cli, line.replay);
  add_kinematics(cli, line.kinematics);
  add_trajectory(cli, line.trajectory);
  add_tune(cli, line.tune);
  add_identify(cli, line.identify);
  add_calibrate(cli, line.calibrate);
  add_igtl(cli, line.igtl);
  add_model(cli, line);
  line.store.describe(cli);
  try {
    cli.parse(argc, argv);
    if (!line.version && cli.get_subcommands().empty()) {
      throw CLI::RequiredError("A command");
    }
  } catch (const CLI::ParseError& error) {
    return cli.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::usage);
  }
  const Result<void> result = execute(cli, line);
  return result ? static_cast<int>(ExitCode::done) : report(result.error().code, result.error().text);
}

}  // namespace
}  // namespace interlock::cli

int main(int argc, char** argv) {
  try {
    return interlock::cli::main(argc, argv);
  } catch (const std::exception& error) {
    return interlock::cli::report(interlock::cli::ExitCode::precondition, error.what());
  }
}
