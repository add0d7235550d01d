#include "robot/robot_error.hpp"

namespace interlock {

std::string RobotError::message() const {
  std::string text = file;
  if (line != 0) {
    text += ':' + std::to_string(line);
  }
  text += ": ";
  if (!key.empty()) {
    text += key + ": ";
  }
  return text + problem + "; expected " + expected;
}

}  // namespace interlock
