#include "cli/named_robot.hpp"

namespace interlock::cli {

Result<Robot> named_robot(const std::string& robot, const Installation& installation,
                          std::span<const RobotSetting> settings) {
  return installation.robot(robot).and_then([&](const std::filesystem::path& file) {
    return load_robot(file, settings).map_error([](const RobotError& error) { return robot_failure(error); });
  });
}

}  // namespace interlock::cli
