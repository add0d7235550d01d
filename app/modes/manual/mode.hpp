/**
 * @file
 * Manual mode: each axis goes to its own setpoint for as long as the pedal is held.
 *
 * Times count kernel ticks, so that the simulated clock behaves as the real one.
 */
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "motion/axis_move.hpp"
#include "motion/axis_plan.hpp"
#include "motion/mode.hpp"

namespace interlock {

class ManualMode final : public Mode {
 public:
  explicit ManualMode(const RobotPlan& plan) noexcept;

  [[nodiscard]] bool yields() const noexcept override { return true; }
  /** An open one of the same axis is replaced. */
  void take(const TaskReference& task, std::uint32_t tick) noexcept override;
  void end(std::uint32_t task, TaskReason reason, std::uint32_t tick) noexcept override;
  void end_all(TaskReason reason, std::uint32_t tick) noexcept override;
  void end_axis(std::uint32_t slot, TaskReason reason, std::uint32_t tick) noexcept override;
  void tick(const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept override;
  void on_unsent(const KernelRequest& request) noexcept override;
  void on_verdict(const ModeOrigin& origin, std::uint32_t verdict, std::uint32_t tick) noexcept override;
  /** Whether a move of any axis is open. */
  [[nodiscard]] bool is_open() const noexcept override;
  void report(ControlView& view) const noexcept override;
  void hold_insertion(bool held) noexcept override { insertion_held_ = held; }

 private:
  struct Job {
    AxisMove move;
    std::int32_t target_counts = 0;
    std::uint32_t idle_since = 0; /**< tick since which the task does not execute */
  };

  void set_phase(std::uint32_t slot, TaskPhase phase, TaskReason reason, std::uint32_t code,
                 std::uint32_t tick) noexcept;
  void judge(std::uint32_t slot, const ilk_snapshot_t& snapshot) noexcept;
  [[nodiscard]] bool waits_for_breath(std::uint32_t slot, const ilk_snapshot_t& snapshot) const noexcept;
  void pause_or_expire(std::uint32_t slot, const ilk_snapshot_t& snapshot) noexcept;
  void follow(std::uint32_t slot, const ilk_snapshot_t& snapshot) noexcept;
  [[nodiscard]] bool waited_too_long(std::uint32_t slot, std::uint32_t tick) const noexcept;

  const std::uint32_t timeout_ticks_;
  const std::optional<std::uint32_t> insertion_slot_;
  bool insertion_held_ = false;
  std::array<Job, ILK_SLOTS> jobs_{};
  std::array<TaskStatus, ILK_SLOTS> moves_{};
};

}  // namespace interlock
