/**
 * @file
 * A recording as a table and as a plot.
 */
#pragma once

#include <cstdint>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "chart/time_chart.hpp"
#include "interlock/recorded_block.h"

namespace interlock::cli {

/** Which slots of the recorded robot hold something. */
class ReplayedRobot {
 public:
  explicit ReplayedRobot(const ilk_config_t& config);

  /** With an axis or a sensor. */
  [[nodiscard]] const std::vector<std::uint32_t>& slots() const { return slots_; }
  [[nodiscard]] const std::vector<std::uint32_t>& axes() const { return axes_; }

 private:
  std::vector<std::uint32_t> slots_;
  std::vector<std::uint32_t> axes_;
};

/** Comma-separated: a row a tick. Codes by their names in the catalog, positions in counts. */
class ReplayCsv {
 public:
  ReplayCsv(const ReplayedRobot& robot, std::ostream& output);

  /** Appends the row of one tick. */
  void add(const ilk_recorded_tick_t& tick);

 private:
  const ReplayedRobot& robot_;
  std::ostream& output_;
};

/** Position and drive of each axis over time, the mode below. */
class ReplayPlot {
 public:
  ReplayPlot(const ReplayedRobot& robot, std::string title);

  /** Takes in one tick. */
  void add(const ilk_recorded_tick_t& tick);

  [[nodiscard]] const TimeChart& chart() const { return chart_; }

 private:
  const ReplayedRobot& robot_;
  TimeChart chart_;
  std::optional<std::uint64_t> first_ns_;
};

}  // namespace interlock::cli
