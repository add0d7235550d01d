/**
 * @file
 * What a replay is shown as: a table and a plot, the judgement of the monitors, or the console.
 */
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "chart/time_chart.hpp"
#include "cli/exit_code.hpp"
#include "interlock/recorded_block.h"
#include "interlock/types.h"
#include "monitors.h"

namespace interlock::cli {

// A recording as a table and as a plot.

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

// `interlock replay --judge`: every monitor of the kernel's properties judges each replayed tick.

/** A replayed tick that breaks a property. */
struct Violation {
  std::uint32_t tick; /**< the kernel's counter after it */
  ilk_judgement_t judgement;
};

/** Tick, slot, property, and what was found beside its bound, in the unit of the property. */
std::string describe(const Violation& violation);

/** Judges a recording up to the first violation. What a gap hides is not held against the kernel. */
class ReplayJudge {
 public:
  static constexpr std::uint32_t monitors = JUDGE_COUNT;

  /** Of a kernel with this configuration, which outlives the judge. */
  explicit ReplayJudge(const ilk_config_t& config);

  /** @param before the state before the tick */
  void add(const ilk_state_t& before, const ilk_recorded_tick_t& tick);

  [[nodiscard]] std::uint64_t ticks() const { return ticks_; } /**< judged */
  [[nodiscard]] const std::optional<Violation>& violation() const { return violation_; }

 private:
  const ilk_config_t& config_;
  bool config_valid_;
  ilk_ghost_t ghost_{};
  std::uint64_t ticks_ = 0;
  std::optional<Violation> violation_;
};

// `interlock replay --console`: a recording in the console, in the kernel's place.

/** How a recording is shown. */
struct ReplayShow {
  std::string robot;         /**< name or file; empty: the one that compiles to the recorded configuration */
  std::uint16_t port = 8080; /**< 0: one that is free */
  double speed = 1.0;        /**< multiple of the recorded pace */
};

/**
 * Starts player and app, and runs until a signal or a failure. Both keep what they write in a private
 * directory, which is gone afterwards: the robot's own store, logs and audit trail learn nothing of it.
 *
 * @param config the recorded one
 * @return PRECONDITION when no robot file, or not the named one, compiles to `config`, or the port is busy.
 */
Result<void> show_in_console(const ReplayShow& show, const std::filesystem::path& recording,
                             const ilk_config_t& config, std::ostream& output);

}  // namespace interlock::cli
