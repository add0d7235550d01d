/**
 * @file
 * The system as a monitoring server sees it: Prometheus' text format, version 0.0.4
 * (https://prometheus.io/docs/instrumenting/exposition_formats/), in its base units.
 */
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

#include "motion/realtime_channel.hpp"
#include "robot/robot.hpp"

namespace interlock {

/** Media type of the text. */
inline constexpr const char* metrics_media_type = "text/plain; version=0.0.4; charset=utf-8";

/** What the app counts by itself. */
struct AppCounts {
  std::array<std::size_t, 3> alarms{}; /**< that are there: of priority low, medium and high */
  std::size_t consoles = 0;            /**< clients of the stream */
  std::uint64_t log_lines_lost = 0;    /**< since the app started, as the next */
  std::uint64_t role_refusals = 0;     /**< requests of users whose role does not suffice */
};

/**
 * Every metric of docs/deployment.md. What the kernel alone knows is left out while none is attached: a
 * series that ends is told from one that stands still.
 *
 * @param now of the clock that stamped the view
 */
[[nodiscard]] std::string metrics_text(const Robot& robot, const ilk_config_t& config,
                                       const ControlView& view, const AppCounts& counts,
                                       std::chrono::steady_clock::time_point now);

}  // namespace interlock
