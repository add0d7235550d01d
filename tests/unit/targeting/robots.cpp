#include "robots.hpp"

#include <stdexcept>

namespace interlock::test {

RobotKinematics kinematics_of(const Robot& robot) {
  const auto kinematics = RobotKinematics::create(robot);
  return kinematics ? *kinematics : throw std::runtime_error(kinematics.error().message());
}

std::size_t place_of(const Robot& robot, std::string_view role) {
  return static_cast<std::size_t>(robot.with_role(role) - robot.axes.data());
}

}  // namespace interlock::test
