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

KeyPlace Origin::place_of(std::string_view key) const {
  if (const auto found = keys.find(key); found != keys.end()) {
    return found->second;
  }
  const std::size_t dot = key.rfind('.');
  return dot == std::string_view::npos ? KeyPlace{} : KeyPlace{place_of(key.substr(0, dot)).line};
}

}  // namespace interlock
