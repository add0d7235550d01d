#include "project_robots.hpp"

#include <stdexcept>

#include "robot/robot_file.hpp"

namespace interlock::test {
namespace {

Robot robot_of(const char* file) {
  auto loaded = load_robot(file);
  return loaded ? *loaded : throw std::runtime_error(loaded.error().message());
}

}  // namespace

const Robot& neuro() {
  static const Robot robot = robot_of(INTERLOCK_ROBOTS "/neuro.toml");
  return robot;
}

const Robot& prostate() {
  static const Robot robot = robot_of(INTERLOCK_ROBOTS "/prostate.toml");
  return robot;
}

}  // namespace interlock::test
