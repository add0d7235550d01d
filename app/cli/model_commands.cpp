#include "cli/commands.hpp"
#include "cli/model_summary.hpp"
#include "robot/compile.hpp"
#include "robot/robot_file.hpp"

namespace interlock::cli {

namespace fs = std::filesystem;

namespace {

tl::expected<CompiledRobot, RobotError> compiled_robot(const fs::path& file) {
  tl::expected<Robot, RobotError> robot = load_robot(file);
  if (!robot) {
    return tl::unexpected(robot.error());
  }
  const tl::expected<ilk_config_t, RobotError> config = compile(*robot);
  if (!config) {
    return tl::unexpected(config.error());
  }
  return CompiledRobot{std::move(*robot), *config};
}

}  // namespace

Result<CompiledRobot> load_and_compile(const fs::path& file) {
  return compiled_robot(file).map_error([](const RobotError& error) { return robot_failure(error); });
}

Result<void> save_config(const ilk_config_t& config, const fs::path& file) {
  const tl::expected<void, std::string> written = write_config(config, file);
  if (!written) {
    return failed(ExitCode::precondition, written.error() + "; choose another file or free some space");
  }
  return {};
}

Result<void> check_model(const fs::path& file, bool as_json, std::ostream& output) {
  const tl::expected<CompiledRobot, RobotError> compiled = compiled_robot(file);
  if (!compiled) {
    output << (as_json ? model_json(compiled.error()) : "");
    return tl::unexpected(robot_failure(compiled.error()));
  }
  const auto& [robot, config] = *compiled;
  output << (as_json ? model_json(robot, config) : model_text(robot, config));
  return {};
}

Result<void> compile_model(const fs::path& file, const fs::path& config_file, std::ostream& output) {
  const Result<CompiledRobot> compiled = load_and_compile(file);
  if (!compiled) {
    return tl::unexpected(compiled.error());
  }
  const fs::path target = config_file.empty() ? fs::path(compiled->robot.name + ".ilkc") : config_file;
  const Result<void> saved = save_config(compiled->config, target);
  if (saved) {
    output << target.string() << ": configuration " << config_hash(compiled->config) << " of "
           << compiled->robot.name << '\n';
  }
  return saved;
}

}  // namespace interlock::cli
