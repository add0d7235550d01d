#include "cli/named_robot.hpp"

#include "robot/robot_file.hpp"

namespace interlock::cli {

Result<Robot> named_robot(const std::string& robot, const Installation& installation) {
  return installation.robot(robot).and_then([](const std::filesystem::path& file) {
    return load_robot(file).map_error(
        [](const RobotError& error) { return Failure{ExitCode::refused, error.message()}; });
  });
}

}  // namespace interlock::cli
