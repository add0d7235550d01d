/**
 * @file
 * A mode whose one task is carried out for as long as the pedal is held, whatever it moves.
 *
 *     waiting -> executing <-> paused -> done, or refused, aborted, expired
 *
 * Release of the pedal pauses, the next press goes on, and a task that does not execute for too long expires.
 * A task may have a part that needs a confirmation: before it, it pauses until somebody gives one.
 * An axis that cannot be moved, a refusal or a lock ends it for all its axes, and so does one that has to
 * stand still, when it is moved.
 */
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "motion/axis_plan.hpp"
#include "motion/mode.hpp"

namespace interlock {

class HeldMode : public Mode {
 public:
  void take(const TaskReference& task, std::uint32_t tick) noexcept final;
  void await_press() noexcept final { needs_release_ = true; }
  void confirm(std::uint32_t task, std::uint32_t tick) noexcept final;
  void end(std::uint32_t task, TaskReason reason, std::uint32_t tick) noexcept final;
  void end_all(TaskReason reason, std::uint32_t tick) noexcept final;
  void end_axis(std::uint32_t slot, TaskReason reason, std::uint32_t tick) noexcept final;
  void tick(const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept override;
  /** A refusal ends the task; MODE says only that the pedal was released meanwhile, which the next snapshot
   * shows. */
  void on_verdict(const ModeOrigin& origin, std::uint32_t verdict, std::uint32_t tick) noexcept final;
  [[nodiscard]] bool is_open() const noexcept final { return interlock::is_open(status_.phase); }
  void report(ControlView& view) const noexcept override;

  [[nodiscard]] const TaskStatus& status() const noexcept { return status_; }

 protected:
  HeldMode(const std::type_info& tasks, const RobotPlan& plan) noexcept;

  /** Makes ready for a task that waits now; returns the axes that it moves, bit n for slot n. */
  [[nodiscard]] virtual std::uint32_t prepare(std::uint32_t tick) noexcept = 0;
  /** The pedal was pressed: from the start, or on after a pause. */
  virtual void begin(const ilk_snapshot_t& snapshot) noexcept = 0;
  /** It is held. */
  virtual void go_on(const ilk_snapshot_t& snapshot) noexcept = 0;
  /** Requests for what drives each axis now, or gives back its drive. */
  virtual void drive(const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept = 0;

  /** Aborts the task because of the axis in `slot`. */
  void fail(TaskReason reason, std::uint32_t code, std::uint32_t slot, std::uint32_t tick) noexcept;
  /** What comes next needs a confirmation: until then no press goes on. What somebody looks at and confirms
   * is where the axes of the task stand now, and each has to stay there until it may move. */
  void await_confirmation(const ilk_snapshot_t& snapshot) noexcept;
  /** These axes, bit n for slot n, need not stay where they stand. */
  void let_move(std::uint32_t axes) noexcept;
  /** It was carried out. */
  void finish(TaskReason reason, std::uint32_t tick) noexcept { set_phase(TaskPhase::done, reason, 0, tick); }
  void set_step(std::uint32_t step) noexcept { status_.step = step; }
  /** While it executes: what it waits for under the held pedal, or `none`. */
  void wait_for(TaskReason reason) noexcept { status_.reason = executes() ? reason : status_.reason; }

  /** The work of the newest task. */
  template <typename Kind>
  [[nodiscard]] const Kind& work() const noexcept {
    return task_->work.as<Kind>();
  }
  [[nodiscard]] bool executes() const noexcept { return status_.phase == TaskPhase::executing; }
  /** Whether the task has a part for that slot. */
  [[nodiscard]] bool moves(std::uint32_t slot) const noexcept {
    return slot < ILK_SLOTS && ((axes_ >> slot) & 1u) != 0;
  }

 private:
  void set_phase(TaskPhase phase, TaskReason reason, std::uint32_t code, std::uint32_t tick) noexcept;
  void judge(const ilk_snapshot_t& snapshot) noexcept;
  [[nodiscard]] bool is_blocked(const ilk_snapshot_t& snapshot) noexcept;
  [[nodiscard]] bool is_undermined(const ilk_snapshot_t& snapshot) noexcept;

  std::array<std::uint32_t, ILK_SLOTS> tolerances_{}; /**< see `rest_tolerance_counts` */
  const std::uint32_t timeout_ticks_;                 /**< how long the task may wait without executing */
  const std::uint32_t confirmation_ticks_;            /**< the same of a confirmation */
  TaskReference task_;
  TaskStatus status_;
  std::uint32_t axes_ = 0;
  std::array<std::optional<std::int32_t>, ILK_SLOTS> kept_{}; /**< where an axis has to stand */
  bool needs_release_ = false;   /**< the pedal, before the task begins or goes on after a confirmation */
  std::uint32_t idle_since_ = 0; /**< tick since which the task does not execute */
};

}  // namespace interlock
