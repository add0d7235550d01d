/**
 * @file
 * The time of day, which is recorded, and the time that passes, by which limits run: whoever sets the clock
 * neither ends nor prolongs them.
 */
#pragma once

#include <chrono>
#include <functional>

#include "system/utc_time.hpp"

namespace interlock {

/** A time that only runs forward. */
using SteadyTime = std::chrono::steady_clock::time_point;

/** Both clocks; tests bring their own. */
struct Clocks {
  std::function<UtcTime()> utc = [] { return std::chrono::system_clock::now(); };
  std::function<SteadyTime()> steady = [] { return std::chrono::steady_clock::now(); };
};

}  // namespace interlock
