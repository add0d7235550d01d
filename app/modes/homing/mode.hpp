/**
 * @file
 * Home mode: runs home steps one after the other for as long as the pedal is held.
 *
 *     waiting -> executing <-> paused -> done, or refused, aborted, expired
 *
 * The kernel homes an axis; the mode asks for it and watches. Release of the pedal drops whatever is under
 * way, and the next press goes on with what is left of the step. One failure ends the whole task. The kernel
 * knows no request that ends homing of one axis, so a task that ends early asks for STOP while the kernel
 * may be homing.
 */
#pragma once

#include <array>
#include <cstdint>

#include "modes/homing/home_axis.hpp"
#include "motion/axis_plan.hpp"
#include "motion/mode.hpp"

namespace interlock {

class HomeMode final : public Mode {
 public:
  explicit HomeMode(const RobotPlan& plan);

  [[nodiscard]] bool homes() const noexcept override { return true; }
  /** One that names what the robot has not is refused (AXIS). */
  void take(const TaskReference& task, std::uint32_t tick) noexcept override;
  void await_press() noexcept override { slices_used_ = true; }
  void end(std::uint32_t task, TaskReason reason, std::uint32_t tick) noexcept override;
  void end_all(TaskReason reason, std::uint32_t tick) noexcept override;
  void end_axis(std::uint32_t slot, TaskReason reason, std::uint32_t tick) noexcept override;
  void tick(const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept override;
  void on_unsent(const KernelRequest& request) noexcept override;
  void on_verdict(const ModeOrigin& origin, std::uint32_t verdict, std::uint32_t tick) noexcept override;
  void on_verdict_lost(const ModeOrigin& origin, std::uint32_t tick) noexcept override;

  [[nodiscard]] bool is_open() const noexcept override { return interlock::is_open(status_.phase); }
  void report(ControlView& view) const noexcept override;

 private:
  void set_phase(TaskPhase phase, TaskReason reason, std::uint32_t code, std::uint32_t tick) noexcept;
  void finish(TaskPhase phase, TaskReason reason, std::uint32_t code, std::uint32_t tick) noexcept;
  void fail(TaskReason reason, std::uint32_t code, std::uint32_t slot, std::uint32_t tick) noexcept;
  void judge(const ilk_snapshot_t& snapshot) noexcept;
  [[nodiscard]] bool is_blocked(const ilk_snapshot_t& snapshot) noexcept;
  void wait(const ilk_snapshot_t& snapshot) noexcept;
  void go_on(const ilk_snapshot_t& snapshot) noexcept;
  void follow_step(const ilk_snapshot_t& snapshot) noexcept;
  void pause(TaskReason reason, const ilk_snapshot_t& snapshot) noexcept;
  void begin_step() noexcept;
  void end_step(const ilk_snapshot_t& snapshot) noexcept;
  void start_axes(const ilk_snapshot_t& snapshot) noexcept;
  [[nodiscard]] const HomeStepPlan& step() const noexcept;
  [[nodiscard]] const HomeTask& homing() const noexcept { return task_->work.as<HomeTask>(); }
  [[nodiscard]] bool names_known_steps(const HomeTask& homing) const noexcept;
  [[nodiscard]] bool expire_when_late(std::uint32_t tick) noexcept;
  void settle_stop(const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept;

  const RobotPlan plan_;
  HomeStepPlan alone_; /**< the step of a task for one axis */
  std::array<HomeAxis, ILK_SLOTS> axes_{};
  TaskReference task_;
  TaskStatus status_;
  std::uint32_t steps_done_ = 0;
  std::uint32_t involved_ = 0;     /**< bit n: the task moves the axis in slot n */
  std::uint32_t homed_ = 0;        /**< bit n: slot n was homed by this task */
  std::uint32_t known_faults_ = 0; /**< bit n: slot n is faulted since before the task, and not in it */
  bool fresh_ = false;             /**< no snapshot was seen since the task came */
  bool slices_used_ = false;       /**< nothing is left to do in this press */
  std::uint32_t idle_since_ = 0;   /**< tick since which the task does not execute */
  bool stop_owed_ = false;         /**< the kernel may be homing for a task that has ended */
  bool stop_sent_ = false;
  std::uint32_t stop_tick_ = 0; /**< in which STOP was last requested */
};

}  // namespace interlock
