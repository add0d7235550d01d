/**
 * @file
 * The modes together: hands each task to its mode and sees to it that only one mode has open tasks.
 */
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "motion/biopsy_mode.hpp"
#include "motion/home_mode.hpp"
#include "motion/manual_mode.hpp"
#include "motion/path_mode.hpp"
#include "motion/sweep_mode.hpp"

namespace interlock {

class ModeManager {
 public:
  explicit ModeManager(const RobotPlan& plan)
      : manual_(plan), home_(plan), path_(plan), sweep_(plan), biopsy_(plan) {}
  ModeManager(const ModeManager&) = delete;
  ModeManager& operator=(const ModeManager&) = delete;

  /** Takes a task, and ends what is open in other modes; but a move ends itself when another mode is open. */
  void take(const TaskReference& task, std::uint32_t tick) noexcept;

  /** An image for the open biopsy. */
  void see(const SeenImage& seen) noexcept { biopsy_.see(seen); }

  /** Aborts that task, if it is open. */
  void end(std::uint32_t task, TaskReason reason, std::uint32_t tick) noexcept;

  /** Aborts the open task that moves the axis in `slot`, if there is one. */
  void end_axis(std::uint32_t slot, TaskReason reason, std::uint32_t tick) noexcept;

  /** Ends every open task for that reason. */
  void end_all(TaskReason reason, std::uint32_t tick) noexcept;

  /** The requests to send in this tick, first one first. */
  [[nodiscard]] KernelRequests tick(const ilk_snapshot_t& snapshot) noexcept;

  /** A request that the link did not take. */
  void on_unsent(const KernelRequest& request) noexcept;
  /** The kernel's answer to a request. */
  void on_verdict(const ModeOrigin& origin, std::uint32_t verdict, std::uint32_t tick) noexcept;
  /** The kernel's answer to a request will never be known. */
  void on_verdict_lost(const ModeOrigin& origin, std::uint32_t tick) noexcept;

  /** Where the newest tasks stand. */
  [[nodiscard]] TaskTable tasks() const noexcept;
  [[nodiscard]] const SweepSpeeds& sweep_speeds() const noexcept { return sweep_.speeds(); }
  /** Where a path or a biopsy wants the axis in `slot` now; nothing when neither moves it. */
  [[nodiscard]] std::optional<Setpoint> setpoint(std::uint32_t slot) const noexcept;

  [[nodiscard]] const BiopsyMode& biopsy() const noexcept { return biopsy_; }

 private:
  ManualMode manual_;
  HomeMode home_;
  PathMode path_;
  SweepMode sweep_;
  BiopsyMode biopsy_;
  /** By their kind. */
  const std::array<Mode*, std::variant_size_v<Work>> by_kind_{&manual_, &home_, &path_, &sweep_, &biopsy_};
  /** Homing last: the others give back their leases before it asks for their axes. */
  const std::array<Mode*, std::variant_size_v<Work>> in_turn_{&manual_, &path_, &sweep_, &biopsy_, &home_};
};

}  // namespace interlock
