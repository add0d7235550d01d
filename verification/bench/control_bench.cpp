/// Times the control tick of all axes of a robot: velocity estimate, controller and drive map of
/// each, on readings of axes that move. Prints one JSON object.
///
/// Usage: control_bench ROBOT_FILE

#include <cmath>
#include <cstdint>
#include <iostream>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "control/axis_controller.hpp"
#include "robot/robot_file.hpp"
#include "timing.hpp"

namespace {

constexpr std::uint32_t kWarmUpTicks = 1000;
constexpr std::uint32_t kMeasuredTicks = 100'000;
constexpr double kFullSpeed = 1000.0;
constexpr double kSpeed = 600.0;

/// One tick of every axis; the sum of the drives keeps the work alive.
std::uint64_t control_tick(std::vector<interlock::AxisController>& controllers, const ilk_axis_t& seen,
                           std::uint32_t tick, const interlock::Setpoint& setpoint) {
  std::uint64_t drives = 0;
  for (interlock::AxisController& controller : controllers) {
    drives += controller.update(seen, tick, setpoint, 1'000'000'000).drive;
  }
  return drives;
}

}  // namespace

int main(int argc, char** argv) {
  const auto robot = interlock::load_robot(argc == 2 ? argv[1] : "");
  if (!robot) {
    std::cerr << robot.error().message() << "\n";
    return 1;
  }
  std::vector<interlock::AxisController> controllers;
  for (const interlock::Axis& axis : robot->axes) {
    const auto made =
        interlock::AxisController::create(interlock::control_rules(axis, robot->period_us, kFullSpeed));
    if (!made) {
      std::cerr << axis.name << ": " << made.error().message() << "\n";
      return 1;
    }
    controllers.push_back(*made);
  }
  std::vector<std::int64_t> times;
  times.reserve(kMeasuredTicks);
  std::uint64_t drives = 0;
  for (std::uint32_t tick = 0; tick < kWarmUpTicks + kMeasuredTicks; ++tick) {
    const double position = kSpeed * tick * 1e-3;
    ilk_axis_t seen{};
    seen.position_counts = static_cast<std::int32_t>(std::floor(position));
    seen.card_time_us = tick * robot->period_us;
    const std::int64_t spent_ns = interlock::bench::time_of(
        [&] { drives += control_tick(controllers, seen, tick, {position, kSpeed, 0.0}); });
    if (tick >= kWarmUpTicks) {
      times.push_back(spent_ns);
    }
  }
  if (drives == 0) {
    std::cerr << "no axis was driven\n";
    return 1;
  }
  nlohmann::json printed = interlock::bench::summary(std::move(times));
  printed["axes"] = controllers.size();
  std::cout << printed.dump() << "\n";
  return 0;
}
