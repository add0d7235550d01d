/**
 * @file
 * The modes, the real kernel core and the real plant in one process, tick by tick, with the latency of a
 * link.
 */
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "interlock/kernel.h"
#include "interlock/link.h"
#include "modes/biopsy/mode.hpp"
#include "motion/mode_manager.hpp"
#include "plant/plant.hpp"
#include "robot_fixture.hpp"
#include "tasks.hpp"

namespace interlock::test {

class ClosedLoop {
 public:
  /** `latency` ticks pass from a snapshot until its moves reach the kernel. The system is unlocked and READY.
   */
  ClosedLoop(std::uint64_t seed, std::uint32_t latency, const Robot& robot = neuro());
  ClosedLoop(std::uint64_t seed, std::uint32_t latency, const Robot& robot, const plant::Parameters& plant);

  /** Calls `subscriber` after every tick. */
  void watch(std::function<void()> subscriber) { subscriber_ = std::move(subscriber); }

  void tick();
  void run(std::uint32_t ticks);

  /** Presses or releases the pedal and waits for MOTION or READY. */
  void pedal(bool pressed);

  /** Sends one request, which the kernel must accept. */
  void request(std::uint32_t kind, std::uint32_t slot = 0, std::int32_t target_counts = 0);

  /** Enables every axis of the robot. */
  void enable_all();

  /** True position of the axis, in the frame of its switch. */
  [[nodiscard]] double true_position(std::uint32_t slot) const {
    return plant_.station(slot)->position_counts();
  }

  /** True position of what the axis moves, behind the play of its tool. */
  [[nodiscard]] double true_tool(std::uint32_t slot) const { return plant_.station(slot)->tool_counts(); }

  /** Declares every axis homed where it stands, enables them all and holds the pedal. */
  void make_all_ready();

  /** Homes the axis as it wants to be homed, enables it, and holds the pedal. */
  void make_ready(std::uint32_t slot);

  /** Gives a task at the tick that the mode sees. */
  void give_under_any_pedal(std::uint32_t id, Work work) {
    modes_.take(task_of(id, std::move(work)), seen_tick_);
  }

  /** The same; a held pedal is pressed anew where the task needs that. */
  void give(std::uint32_t id, Work work, std::vector<AxisCounts> rests_on = {}) {
    const bool is_move = work.find<MoveTask>() != nullptr;
    modes_.take(task_of(id, std::move(work), std::move(rests_on)), seen_tick_);
    if (!is_move && state_.system.mode == ILK_MODE_MOTION) {
      pedal(false);
      pedal(true);
    }
  }

  /** Gives a task and returns its status once it is final, or after so many ticks. */
  TaskStatus carry_out(std::uint32_t id, const Work& work, std::uint32_t most_ticks);

  /** The verdict of a MOVE to that setpoint, sent now. */
  std::uint32_t verdict_of_move(std::uint32_t slot, std::int32_t target_counts, std::uint32_t drive);

  [[nodiscard]] const ilk_state_t& state() const { return state_; }
  [[nodiscard]] const ilk_outputs_t& outputs() const { return outputs_; }
  [[nodiscard]] const ilk_config_t& config() const { return config_; }
  [[nodiscard]] TaskStatus move(std::uint32_t slot) const { return reported().tasks.move(slot); }
  [[nodiscard]] TaskStatus status(const std::type_info& tasks) const { return reported().tasks.of(tasks); }
  [[nodiscard]] TaskStatus home() const { return status(typeid(HomeTask)); }
  [[nodiscard]] TaskStatus path() const { return status(typeid(PathTask)); }
  [[nodiscard]] TaskStatus sweep() const { return status(typeid(SweepTask)); }
  [[nodiscard]] std::optional<Setpoint> setpoint(std::uint32_t slot) const { return modes_.setpoint(slot); }
  [[nodiscard]] const SweepSpeeds& sweep_speeds() const { return reported().sweep_speeds; }
  [[nodiscard]] const MeasuredAxis& measured() const { return reported().measured; }
  [[nodiscard]] const BiopsyMode& biopsy() const {
    return dynamic_cast<const BiopsyMode&>(*modes_.find(typeid(BiopsyTask)));
  }
  void show(const SeenImage& image) { modes_.see(image); }
  [[nodiscard]] std::uint32_t seen_tick() const { return seen_tick_; }
  plant::Plant& plant() { return plant_; }

  /** The app falls silent but for its heartbeat, or speaks again. */
  void silence(bool silent) { silent_ = silent; }
  void hold(StandStill still) { modes_.hold(still); }
  void confirm(std::uint32_t task) { modes_.confirm(task, seen_tick_); }
  void cancel(std::uint32_t task) { modes_.end(task, TaskReason::cancelled, seen_tick_); }

  /** STOP, as the control thread obeys it. */
  void stop();

  /** A hand or a fault does something to the plant. */
  void happen(const plant::command::Command& command);
  /** Requests that the kernel refused, but for those that a released pedal overtook (MODE). */
  [[nodiscard]] std::uint32_t refusals() const { return refusals_; }
  [[nodiscard]] std::uint32_t most_requests_in_a_tick() const { return most_requests_; }

 private:
  struct Sent {
    std::uint32_t sequence;
    ModeOrigin origin;
  };

  void put(ilk_request_t request);
  /** What the modes report now. */
  [[nodiscard]] ControlView& reported() const {
    modes_.report(view_);
    return view_;
  }
  [[nodiscard]] ilk_snapshot_t snapshot() const;
  void deliver_verdicts();

  const Robot robot_;
  ilk_config_t config_;
  ilk_state_t state_{};
  ilk_outputs_t outputs_{};
  ilk_inputs_t inputs_{};
  bool silent_ = false;
  plant::Plant plant_;
  ModeManager modes_;
  mutable ControlView view_;
  std::uint32_t latency_;
  std::function<void()> subscriber_ = [] {};
  std::uint32_t seen_tick_ = 0;
  std::deque<ilk_snapshot_t> on_their_way_;
  std::vector<ilk_request_t> requests_;
  std::vector<Sent> sent_;
  std::uint32_t sequence_ = 0;
  std::uint32_t most_requests_ = 0;
  std::uint32_t refusals_ = 0;
};

}  // namespace interlock::test
