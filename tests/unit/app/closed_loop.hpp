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
#include "motion/conductor.hpp"
#include "plant/plant.hpp"
#include "robot_fixture.hpp"

namespace interlock::test {

class ClosedLoop {
 public:
  /** `latency` ticks pass from a snapshot until its moves reach the kernel. The system is unlocked and READY.
   */
  ClosedLoop(std::uint64_t seed, std::uint32_t latency, const Robot& robot = neuro());
  ClosedLoop(std::uint64_t seed, std::uint32_t latency, const Robot& robot, const plant::Parameters& plant);

  /** Calls `watcher` after every tick. */
  void watch(std::function<void()> watcher) { watcher_ = std::move(watcher); }

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

  /** Declares every axis homed where it stands, enables them all and holds the pedal. */
  void make_all_ready();

  /** Homes the axis as it wants to be homed, enables it, and holds the pedal. */
  void make_ready(std::uint32_t slot);

  /** Gives an order at the tick that the mode sees. */
  void give(const Order& order) { conductor_.take(order, seen_tick_); }
  void give(const HomeOrder& order) { conductor_.take(order, seen_tick_); }
  void give(const PathOrder& order) { conductor_.take(order, seen_tick_); }
  void give(const BiopsyOrder& order) { conductor_.take(order, seen_tick_); }
  void give(const SweepOrder& order) { conductor_.take(order, seen_tick_); }

  /** Gives a path and returns its status once it is final, or after so many ticks. */
  PathStatus carry_out(const PathOrder& order, std::uint32_t most_ticks);

  /** Gives an order and returns its status once it is final, or after so many ticks. */
  OrderStatus carry_out(const Order& order, std::uint32_t most_ticks);

  /** The verdict of a MOVE to that setpoint, sent now. */
  std::uint32_t verdict_of_move(std::uint32_t slot, std::int32_t target_counts, std::uint32_t drive);

  [[nodiscard]] const ilk_state_t& state() const { return state_; }
  [[nodiscard]] const ilk_outputs_t& outputs() const { return outputs_; }
  [[nodiscard]] const ilk_config_t& config() const { return config_; }
  [[nodiscard]] OrderStatus order(std::uint32_t slot) const { return conductor_.orders()[slot]; }
  [[nodiscard]] const HomeStatus& home() const { return conductor_.home(); }
  [[nodiscard]] const PathStatus& path() const { return conductor_.path(); }
  [[nodiscard]] std::optional<Setpoint> setpoint(std::uint32_t slot) const {
    return conductor_.setpoint(slot);
  }
  [[nodiscard]] const SweepStatus& sweep() const { return conductor_.sweep(); }
  [[nodiscard]] const BiopsyMode& biopsy() const { return conductor_.biopsy(); }
  void show(const SeenImage& image) { conductor_.see(image); }
  [[nodiscard]] std::uint32_t seen_tick() const { return seen_tick_; }
  plant::Plant& plant() { return plant_; }

  /** The app falls silent but for its heartbeat, or speaks again. */
  void silence(bool silent) { silent_ = silent; }
  void cancel(std::uint32_t proposal) { conductor_.end(proposal, OrderReason::cancelled, seen_tick_); }

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
    WishOrigin origin;
  };

  void put(ilk_request_t request);
  [[nodiscard]] ilk_snapshot_t snapshot() const;
  void deliver_verdicts();

  const Robot robot_;
  ilk_config_t config_;
  ilk_state_t state_{};
  ilk_outputs_t outputs_{};
  ilk_inputs_t inputs_{};
  bool silent_ = false;
  plant::Plant plant_;
  Conductor conductor_;
  std::uint32_t latency_;
  std::function<void()> watcher_ = [] {};
  std::uint32_t seen_tick_ = 0;
  std::deque<ilk_snapshot_t> on_their_way_;
  std::vector<ilk_request_t> requests_;
  std::vector<Sent> sent_;
  std::uint32_t sequence_ = 0;
  std::uint32_t most_requests_ = 0;
  std::uint32_t refusals_ = 0;
};

}  // namespace interlock::test
