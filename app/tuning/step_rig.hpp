/**
 * @file
 * The kernel core and the simulated plant in this process, tick by tick, far faster than real time: one axis
 * is homed, enabled and moved with the pedal held. No other process, socket or clock takes part.
 *
 * Each tick is an exchange of the plant, then a step of the kernel, as in the executive. A request that is
 * put after a tick reaches the kernel in the next one, and its drive the plant one later.
 */
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "interlock/kernel.h"
#include "plant/plant.hpp"
#include "robot/robot.hpp"

namespace interlock {

/** A value, or why the rig has none. */
template <typename Value>
using RigResult = tl::expected<Value, std::string>;

/** Kernel core and plant in this process, with one axis that moves. */
class StepRig {
 public:
  /** `config` is the compiled `robot`; `axis` one of its axes. */
  StepRig(const ilk_config_t& config, const plant::Parameters& parameters, std::uint64_t seed,
          std::uint32_t slot);

  /** Unlocks, enables and homes the axis, at its switch or where it stands, and holds the pedal. `watch` sees
   * each tick of homing at the switch. */
  RigResult<void> make_ready(const std::function<void(const ilk_axis_t&)>& watch = [](const ilk_axis_t&) {});

  /** Asks for a move in the next tick. */
  void move(std::int32_t target_counts, std::uint32_t drive);

  /** One tick. The error names the fault, cause or verdict that ended the motion. */
  RigResult<void> tick();

  [[nodiscard]] const ilk_axis_t& axis() const { return state_.axis[slot_]; }
  [[nodiscard]] std::uint32_t tick_count() const { return state_.system.tick; }

  /** What the kernel drives the axis with now. */
  [[nodiscard]] std::uint32_t drive() const { return outputs_.command[slot_].drive; }

  /** True position, in the frame of the axis' switch. */
  [[nodiscard]] double true_position_counts() const { return plant_axis().position_counts(); }

  /** True speed, positive towards larger positions. */
  [[nodiscard]] double true_speed_counts_per_s() const { return plant_axis().speed_counts_per_s(); }

 private:
  void put(ilk_request_t request);
  void ask(ilk_request_kind_t kind);
  RigResult<void> begin_motion(bool sets_home);
  RigResult<void> run(std::uint32_t ticks);
  [[nodiscard]] RigResult<void> judge() const;
  [[nodiscard]] const plant::Axis& plant_axis() const { return *plant_.station(slot_)->axis; }

  ilk_config_t config_;
  std::uint32_t slot_;
  std::uint32_t settle_ticks_;
  plant::Plant plant_;
  ilk_state_t state_{};
  ilk_outputs_t outputs_{};
  std::vector<ilk_request_t> requests_;
  std::uint32_t sequence_ = 0;
  bool may_drive_ = false; /**< the newest MOVE asked for drive */
};

}  // namespace interlock
