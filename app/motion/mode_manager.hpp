/**
 * @file
 * The modes together: hands each task to its mode and sees to it that only one mode has open tasks, and that
 * none strains a linkage.
 */
#pragma once

#include <cstdint>
#include <optional>
#include <typeinfo>

#include "motion/linkage_watch.hpp"
#include "motion/mode.hpp"
#include "motion/outside_holds.hpp"

namespace interlock {

class ModeManager {
 public:
  /** @param modes one for each type of task */
  ModeManager(Modes modes, LinkageWatch linkages);
  ModeManager(const ModeManager&) = delete;
  ModeManager& operator=(const ModeManager&) = delete;

  /** Takes a task, and ends what is open in other modes; but one that yields ends itself when another mode is
   * open. A pedal that is held by then starts none but a move of one axis. */
  void take(const TaskReference& task, std::uint32_t tick) noexcept;

  /** An image for the open biopsy. */
  void see(const SeenImage& seen) noexcept;

  /** That task may go on to what needs a confirmation, if it waits for one. */
  void confirm(std::uint32_t task, std::uint32_t tick) noexcept;

  /** Aborts that task, if it is open. */
  void end(std::uint32_t task, TaskReason reason, std::uint32_t tick) noexcept;

  /** Aborts the open task that moves the axis in `slot`, if there is one. */
  void end_axis(std::uint32_t slot, TaskReason reason, std::uint32_t tick) noexcept;

  /** Ends every open task for that reason. */
  void end_all(TaskReason reason, std::uint32_t tick) noexcept;

  /** What stands still from the next tick on. Everything: MOTION is ended, and the modes see a pedal that is
   * not held. */
  void hold(StandStill still) noexcept;

  /** The requests to send in this tick, first one first. */
  [[nodiscard]] KernelRequests tick(const ilk_snapshot_t& snapshot) noexcept;

  /** A request that the link did not take. */
  void on_unsent(const KernelRequest& request) noexcept;
  /** The kernel's answer to a request. */
  void on_verdict(const ModeOrigin& origin, std::uint32_t verdict, std::uint32_t tick) noexcept;
  /** The kernel's answer to a request will never be known. */
  void on_verdict_lost(const ModeOrigin& origin, std::uint32_t tick) noexcept;

  /** Writes where the newest tasks stand, and what else the modes have found. */
  void report(ControlView& view) const noexcept;

  /** Where a task wants the axis in `slot` now; nothing when none moves it along a path. */
  [[nodiscard]] std::optional<Setpoint> setpoint(std::uint32_t slot) const noexcept;

  /** The mode that takes tasks of that type, or null. */
  [[nodiscard]] Mode* find(const std::type_info& tasks) const noexcept;

 private:
  /** Homing last: the others give back their leases before it asks for their axes. */
  const Modes modes_;
  LinkageWatch linkages_;
  StandStill still_;
  ilk_snapshot_t seen_{};   /**< by the modes, in the newest tick */
  bool pedal_held_ = false; /**< as they see it */
};

}  // namespace interlock
