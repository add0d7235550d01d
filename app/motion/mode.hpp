/**
 * @file
 * What a motion mode is: it reads each snapshot and adds the requests of that tick. Another part sends them.
 *
 * Every function runs in the control thread: none allocates, blocks or throws.
 */
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <typeinfo>
#include <vector>

#include "interlock/link.h"
#include "motion/axis_tracker.hpp"
#include "motion/kernel_request.hpp"
#include "motion/task.hpp"

namespace interlock {

struct ControlView;
struct SeenImage;

/** One way of turning tasks into motion. */
class Mode {
 public:
  /** @param tasks type of the tasks that it takes, as `typeid(MoveTask)` */
  explicit Mode(const std::type_info& tasks) noexcept : tasks_(tasks) {}
  Mode(const Mode&) = delete;
  Mode& operator=(const Mode&) = delete;
  virtual ~Mode() = default;

  /** The type of its tasks. */
  [[nodiscard]] const std::type_info& tasks() const noexcept { return tasks_; }

  /** Whether a task of it ends itself where another mode is open, in place of what that mode does. */
  [[nodiscard]] virtual bool yields() const noexcept { return false; }

  /** Whether the kernel drives its axes by itself. It asks for them after every other mode has given back its
   * drive. */
  [[nodiscard]] virtual bool homes() const noexcept { return false; }

  /** Takes a task of its kind; an open one that is in its way is replaced. */
  virtual void take(const TaskReference& task, std::uint32_t tick) noexcept = 0;

  /** The pedal was held when the newest task was taken: that begins only once it was released and pressed
   * again. A move of one axis does not wait. */
  virtual void await_press() noexcept {}

  /** That task may go on to what needs a confirmation, if it waits for one: at the next press. */
  virtual void confirm(std::uint32_t /*task*/, std::uint32_t /*tick*/) noexcept {}

  /** Aborts that task, if it is open here. */
  virtual void end(std::uint32_t task, TaskReason reason, std::uint32_t tick) noexcept = 0;

  /** Aborts every open task. */
  virtual void end_all(TaskReason reason, std::uint32_t tick) noexcept = 0;

  /** Aborts the open task that moves the axis in `slot`, if there is one. */
  virtual void end_axis(std::uint32_t slot, TaskReason reason, std::uint32_t tick) noexcept = 0;

  /** Looks at a snapshot; adds the requests to send in this tick. */
  virtual void tick(const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept = 0;

  /** A request of this tick found no room on the link: it is requested again in the next one. */
  virtual void on_unsent(const KernelRequest& request) noexcept = 0;

  /** The kernel judged a request. */
  virtual void on_verdict(const ModeOrigin& origin, std::uint32_t verdict, std::uint32_t tick) noexcept = 0;

  /** The kernel's word on a request got lost. Nothing to do for a MOVE: it is renewed before its lease runs
   * out, and each renewal has a verdict of its own. */
  virtual void on_verdict_lost(const ModeOrigin& /*origin*/, std::uint32_t /*tick*/) noexcept {}

  /** Whether the insertion may not advance now: it waits, without an end of its task, until it may. */
  virtual void hold_insertion(bool /*held*/) noexcept {}

  /** Whether a task is open here. */
  [[nodiscard]] virtual bool is_open() const noexcept = 0;

  /** An image of the needle and its target. */
  virtual void see(const SeenImage& /*seen*/) noexcept {}

  /** Writes where its tasks stand, and what else it has found. */
  virtual void report(ControlView& view) const noexcept = 0;

  /** Where the axis in `slot` should be now; nothing unless a task moves it along a path. */
  [[nodiscard]] virtual std::optional<Setpoint> setpoint(std::uint32_t /*slot*/) const noexcept {
    return std::nullopt;
  }

 private:
  const std::type_info& tasks_;
};

/** Every mode of a robot. */
using Modes = std::vector<std::unique_ptr<Mode>>;

}  // namespace interlock
