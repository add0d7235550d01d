/**
 * @file
 * A proposal: a task, and how far it came.
 *
 *     drafted -> checked -> approved -> executing <-> paused
 *        |          |          |            |
 *        +----------+----------+------------+--> done, refused, aborted or expired, which are final
 */
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interlock/link.h"
#include "motion/task.hpp"
#include "proposals/check_list.hpp"
#include "system/utc_time.hpp"

namespace interlock {

/** Where a proposal stands on its way. */
enum class ProposalState : std::uint8_t {
  drafted,
  checked,
  approved,
  executing,
  paused,
  done,
  refused,
  aborted,
  expired
};

/** As the interface spells it: "drafted". */
std::string_view state_name(ProposalState state) noexcept;

/** Whether the proposal can still become motion. */
bool is_open(ProposalState state) noexcept;

/** Whether the proposal is open and nothing but the pedal keeps it from motion. */
bool is_approved(ProposalState state) noexcept;

/** Whether the proposal may go from one state to the other. */
bool may_become(ProposalState from, ProposalState to) noexcept;

/** One motion that somebody proposed: the task, what was found about it and what became of it. */
struct Proposal {
  TaskReference task;                     /**< never null */
  std::uint32_t id = 0;                   /**< of the task */
  std::vector<std::uint32_t> slots;       /**< of all axes that it moves, each once */
  std::vector<std::string> axes;          /**< their names */
  std::string axis;                       /**< name of the axis; empty when there are several */
  double target = 0.0;                    /**< in the axis' unit; of a move */
  std::string step;                       /**< name of the home step that runs or is next; else empty */
  std::vector<AxisCounts> ends;           /**< where the axes come to rest; of a path, once checked */
  double duration_s = 0.0;                /**< of the planned motion; of a path, once checked */
  std::uint32_t leg = 0;                  /**< index of the leg that runs or is next; of a path */
  std::vector<float> speeds_counts_per_s; /**< measured at each frequency that is over; of a sweep */
  std::optional<MeasuredAxis> measured;   /**< so far; of an identification */
  ProposalState state = ProposalState::drafted;
  UtcTime created;
  std::uint32_t created_tick = 0;  /**< kernel tick */
  bool wants_confirmation = false; /**< before what comes next */
  std::optional<UtcTime> ended;
  std::optional<std::string> verdict; /**< that refused or ended it */
  std::vector<CheckResult> checks;    /**< as last made, in their order */
  /** The kernel as it was when the checks were last made; null before. Plans begin there. */
  std::shared_ptr<const ilk_snapshot_t> checked_against;
  std::string detail; /**< why it is in this state, for people */
  /** Who brought it there: its author, whoever ended it, or `app` when the app or the kernel did. */
  std::string changed_by;

  /** What it is to do, if it is of that kind. */
  template <typename Kind>
  [[nodiscard]] const Kind* work() const noexcept {
    return task->work.find<Kind>();
  }
};

}  // namespace interlock
