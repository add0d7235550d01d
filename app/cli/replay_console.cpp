#include <utility>
#include <vector>

#include "cli/announcement.hpp"
#include "cli/commands.hpp"
#include "cli/free_port.hpp"
#include "cli/installation.hpp"
#include "cli/replay_views.hpp"
#include "cli/runtime_directory.hpp"
#include "cli/supervisor.hpp"
#include "robot/compile.hpp"

namespace interlock::cli {
namespace {

namespace fs = std::filesystem;

/** A robot file and what it compiles to. */
struct Recorded {
  fs::path file;
  CompiledRobot compiled;
};

/** Configurations with the same checksum are the same to app and kernel, too. */
Result<Recorded> robot_of(const ReplayShow& show, const Installation& installation,
                          const ilk_config_t& config) {
  std::vector<fs::path> files = installation.robots();
  if (!show.robot.empty()) {
    const Result<fs::path> named = installation.robot(show.robot);
    if (!named) {
      return tl::unexpected(named.error());
    }
    files = {*named};
  }
  for (const fs::path& file : files) {
    Result<CompiledRobot> compiled = load_and_compile(file);
    if (compiled && compiled->config.crc == config.crc) {
      return Recorded{file, std::move(*compiled)};
    }
  }
  const std::string tried =
      show.robot.empty() ? "none of " + std::to_string(files.size()) + " robot files" : "not " + show.robot;
  return failed(ExitCode::precondition, "configuration " + config_hash(config) + " was recorded, and " +
                                            tried +
                                            " compiles to it; name the robot's file as it was then with "
                                            "--robot FILE");
}

Program player(const ReplayShow& show, const fs::path& recording, const RuntimeDirectory& directory) {
  return {"player",
          "interlock-player",
          {"--recording", recording, "--link", directory.link(), "--speed", std::to_string(show.speed)}};
}

Program app(const fs::path& robot_file, std::uint16_t port, const Installation& installation,
            const RuntimeDirectory& directory) {
  Program program{"app",
                  "interlock-app",
                  {"--robot", robot_file, "--config", directory.config(), "--link", directory.link(),
                   "--replay", "--port", std::to_string(port), "--state", directory.path() / "state"}};
  if (const auto web = installation.web()) {
    program.arguments.insert(program.arguments.end(), {"--web", *web});
  }
  if (const auto documents = installation.documents()) {
    program.arguments.insert(program.arguments.end(), {"--docs", *documents});
  }
  return program;
}

Result<Program> found(Program program, const Installation& installation) {
  return installation.program(program.file).map([&](fs::path file) {
    program.file = std::move(file);
    return std::move(program);
  });
}

}  // namespace

Result<void> show_in_console(const ReplayShow& show, const fs::path& recording, const ilk_config_t& config,
                             std::ostream& output) {
  const Installation installation = Installation::current();
  const Result<Recorded> robot = robot_of(show, installation, config);
  if (!robot) {
    return tl::unexpected(robot.error());
  }
  const Result<std::uint16_t> port = free_port(show.port);
  if (!port) {
    return tl::unexpected(port.error());
  }
  // From here on there is something to clear away, so a signal may no longer end this process by itself.
  const SignalEvents signals;
  const std::string& name = robot->compiled.robot.name;
  const Result<RuntimeDirectory> directory = RuntimeDirectory::make_private(name);
  if (!directory) {
    return tl::unexpected(directory.error());
  }
  if (Result<void> saved = save_config(robot->compiled.config, directory->config()); !saved) {
    return saved;
  }
  Result<Program> playing = found(player(show, recording, *directory), installation);
  Result<Program> showing = found(app(robot->file, *port, installation, *directory), installation);
  if (!playing || !showing) {
    return tl::unexpected(!playing ? playing.error() : showing.error());
  }
  std::vector<Supervised> programs;
  programs.push_back({std::move(*playing), AtEnd::stop_all});
  programs.push_back({std::move(*showing), AtEnd::restart});
  Supervisor supervisor(std::move(programs), signals, output);
  return supervisor.run([&] {
    announce({"Replay of " + recording.filename().string() + ": " + robot->compiled.robot.title +
                  " (configuration " + config_hash(config) + ')',
              "http://127.0.0.1:" + std::to_string(*port) + '/', installation.web().has_value(),
              supervisor.take_first_login()},
             output);
  });
}

}  // namespace interlock::cli
