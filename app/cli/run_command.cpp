#include "cli/run_command.hpp"

#include <sched.h>

#include <chrono>
#include <utility>
#include <vector>

#include "cli/announcement.hpp"
#include "cli/commands.hpp"
#include "cli/free_port.hpp"
#include "cli/instance_lock.hpp"
#include "cli/runtime_directory.hpp"
#include "cli/state_directory.hpp"
#include "cli/supervisor.hpp"
#include "robot/compile.hpp"
#include "store/noted_heads.hpp"

namespace interlock::cli {
namespace {

namespace fs = std::filesystem;

/** The kernel's core must be there, and leave another one for the rest. */
Result<void> check_core(const RunOptions& options) {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  sched_getaffinity(0, sizeof cores, &cores);
  const auto given = options.core.value_or(0);
  if (!options.core || (given < CPU_SETSIZE && CPU_ISSET(given, &cores) && CPU_COUNT(&cores) > 1)) {
    return {};
  }
  return failed(ExitCode::precondition,
                "--core " + std::to_string(given) +
                    ": expected one of at least two cores that this process may use; it has " +
                    std::to_string(CPU_COUNT(&cores)) + "; choose another core, or leave --core out");
}

/** For the recorder to write out a minute on a slow disk. */
constexpr std::chrono::seconds longest_recording_end{30};

/** As systemd gives it: WatchdogSec in app/packaging/systemd/interlock-app.service. */
constexpr std::chrono::seconds app_watchdog{10};

/** Where one run keeps its things. */
struct Places {
  fs::path robot_file;
  fs::path plant_file;
  fs::path state;
  std::optional<fs::path> web;
  std::optional<fs::path> documents;
  std::uint16_t port;
};

std::string url_of(const Places& places) { return "http://127.0.0.1:" + std::to_string(places.port) + '/'; }

Program simulator(const RunOptions& options, const Places& places, const RuntimeDirectory& directory) {
  Program program{"simulator",
                  "interlock-sim",
                  {"--plant", places.plant_file, "--robot", directory.config(), "--bus", directory.bus(),
                   "--control", directory.control()}};
  if (options.seed) {
    program.arguments.insert(program.arguments.end(), {"--seed", std::to_string(*options.seed)});
  }
  program.kept_off_core = options.core;
  return program;
}

Program recorder(const RunOptions& options, const Places& places, const RuntimeDirectory& directory) {
  Program program{"recorder",
                  "interlock-recorder",
                  {"--black-box", directory.black_box(), "--folder", recordings_folder(places.state),
                   "--audit-heads", directory.audit_heads()}};
  program.outlives_parent = true;
  if (options.record) {
    program.arguments.emplace_back("--continuous");
  }
  program.kept_off_core = options.core;
  return program;
}

const char* clock_name(ClockChoice clock) {
  switch (clock) {
    case ClockChoice::real:
      return "real";
    case ClockChoice::sim:
      return "sim";
    default:
      return "paced";
  }
}

Program kernel(const RunOptions& options, const RuntimeDirectory& directory) {
  Program program{
      "kernel",
      "interlock-kernel",
      {"--config", directory.config(), "--bus", "sim:" + directory.bus().string(), "--link", directory.link(),
       "--clock", clock_name(options.clock), "--black-box", directory.black_box()}};
  if (options.black_box_s) {
    program.arguments.insert(program.arguments.end(),
                             {"--black-box-seconds", std::to_string(*options.black_box_s)});
  }
  if (options.speed) {
    program.arguments.insert(program.arguments.end(), {"--speed", std::to_string(*options.speed)});
  }
  if (options.core) {
    program.arguments.insert(program.arguments.end(), {"--core", std::to_string(*options.core)});
  }
  return program;
}

Program app(const RunOptions& options, const Places& places, const RuntimeDirectory& directory) {
  Program program{"app",
                  "interlock-app",
                  {"--robot", places.robot_file, "--config", directory.config(), "--link", directory.link(),
                   "--bench", directory.control(), "--port", std::to_string(places.port), "--state",
                   places.state, "--black-box", directory.black_box(), "--recorder", directory.audit_heads(),
                   "--audit-heads", recordings_folder(places.state) / noted_heads_file_name}};
  if (places.web) {
    program.arguments.insert(program.arguments.end(), {"--web", *places.web});
  }
  if (places.documents) {
    program.arguments.insert(program.arguments.end(), {"--docs", *places.documents});
  }
  if (options.new_store) {
    program.arguments.emplace_back("--new-store");
  }
  if (!options.public_origin.empty()) {
    program.arguments.insert(program.arguments.end(), {"--public-origin", options.public_origin});
  }
  if (!options.trusted_proxy.empty()) {
    program.arguments.insert(program.arguments.end(), {"--trusted-proxy", options.trusted_proxy});
  }
  if (!options.igtl_dialect.empty()) {
    program.arguments.insert(program.arguments.end(), {"--igtl-dialect", options.igtl_dialect});
  }
  if (options.igtl_port) {
    program.arguments.insert(program.arguments.end(), {"--igtl-port", std::to_string(*options.igtl_port)});
  }
  program.kept_off_core = options.core;
  program.watchdog = app_watchdog;
  return program;
}

Result<std::vector<Supervised>> programs_of(const RunOptions& options, const Installation& installation,
                                            const Places& places, const RuntimeDirectory& directory) {
  // The recorder before the kernel: it is stopped after the last tick.
  std::vector<Supervised> programs{
      {simulator(options, places, directory), AtEnd::stop_all},
      {recorder(options, places, directory), AtEnd::restart_or_leave, longest_recording_end},
      {kernel(options, directory), AtEnd::stop_all},
      {app(options, places, directory), AtEnd::restart}};
  for (Supervised& supervised : programs) {
    Result<fs::path> file = installation.program(supervised.program.file);
    if (!file) {
      return tl::unexpected(file.error());
    }
    supervised.program.file = std::move(*file);
  }
  return programs;
}

Result<Places> places_of(const RunOptions& options, const Installation& installation,
                         const fs::path& robot_file, const std::string& robot_name) {
  const Result<fs::path> plant =
      options.plant.empty() ? installation.plant(robot_name) : Result<fs::path>(options.plant);
  const Result<fs::path> state = state_directory(options.state, robot_name);
  if (!plant || !state) {
    return tl::unexpected(!plant ? plant.error() : state.error());
  }
  return Places{robot_file,
                *plant,
                *state,
                options.web.empty() ? installation.web() : options.web,
                installation.documents(),
                options.port};
}

Result<void> supervise(const RunOptions& options, const Installation& installation,
                       const CompiledRobot& compiled, Places places, const InstanceLock& lock,
                       std::ostream& output) {
  const Result<std::uint16_t> port = free_port(options.port);
  if (!port) {
    return tl::unexpected(port.error());
  }
  places.port = *port;
  // From here on there is something to clear away, so a signal may no longer end this process by itself.
  const SignalEvents signals;
  Result<RuntimeDirectory> directory = options.sockets.empty()
                                           ? RuntimeDirectory::make_private(compiled.robot.name)
                                           : RuntimeDirectory::use(options.sockets, compiled.robot.name);
  if (!directory) {
    return tl::unexpected(directory.error());
  }
  lock.describe(url_of(places), directory->is_private() ? directory->path() : "", directory->black_box());
  if (Result<void> saved = save_config(compiled.config, directory->config()); !saved) {
    return saved;
  }
  Result<std::vector<Supervised>> programs = programs_of(options, installation, places, *directory);
  if (!programs) {
    return tl::unexpected(programs.error());
  }
  Supervisor supervisor(std::move(*programs), signals, output);
  return supervisor.run([&] {
    announce({compiled.robot.title + ", simulated (configuration " + config_hash(compiled.config) + ')',
              url_of(places), places.web.has_value(), supervisor.take_first_login()},
             output);
  });
}

}  // namespace

Result<void> run(const RunOptions& options, const Installation& installation, std::ostream& output) {
  if (const Result<void> core = check_core(options); !core) {
    return core;
  }
  const Result<fs::path> robot_file = installation.robot(options.robot);
  if (!robot_file) {
    return tl::unexpected(robot_file.error());
  }
  const Result<CompiledRobot> compiled = load_and_compile(*robot_file);
  if (!compiled) {
    return tl::unexpected(compiled.error());
  }
  const Result<Places> places = places_of(options, installation, *robot_file, compiled->robot.name);
  if (!places) {
    return tl::unexpected(places.error());
  }
  const Result<InstanceLock> lock = InstanceLock::take(places->state);
  if (!lock) {
    return tl::unexpected(lock.error());
  }
  return supervise(options, installation, *compiled, *places, *lock, output);
}

}  // namespace interlock::cli
