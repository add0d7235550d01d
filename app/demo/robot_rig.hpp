/**
 * @file
 * A whole robot in this process: the modes of the app, the kernel core and the simulated plant, tick by tick,
 * far faster than real time. No other process, socket or clock takes part; a scripted foot holds the pedal.
 *
 * Each tick is an exchange of the plant, then a step of the kernel, as in the executive; what the modes wish
 * for after a tick reaches the kernel in the next one.
 */
#pragma once

#include <cstdint>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "interlock/kernel.h"
#include "motion/conductor.hpp"
#include "plant/plant.hpp"
#include "targeting/robot_kinematics.hpp"

namespace interlock {

/** A value, or what went wrong, for people. */
template <typename Value>
using DemoResult = tl::expected<Value, std::string>;

class RobotRig {
 public:
  /** `robot` must outlive it; `config` is the compiled robot. */
  RobotRig(const Robot& robot, const ilk_config_t& config, const plant::Parameters& parameters,
           std::uint64_t seed);

  /** Unlocks, declares the home of axes without a switch, enables all and homes the rest in the file's order.
   */
  DemoResult<void> make_ready();

  /** Carries out a program with the pedal held; the error says which axis ended it and why. */
  DemoResult<void> carry_out(const PathProgram& program);

  /** Where the axes truly are, in their units and order: what a scan would show. */
  [[nodiscard]] AxisPositions true_positions() const;

  /** Simulated time. */
  [[nodiscard]] double time_s() const;

 private:
  struct Sent {
    std::uint32_t sequence = 0;
    WishOrigin origin;
  };

  DemoResult<void> start();
  DemoResult<void> home();
  void tick();
  void run(std::uint32_t ticks);
  void set_pedal(bool pressed);
  DemoResult<void> ask(ilk_request_kind_t kind, const Axis* axis);
  std::uint32_t put(ilk_request_t request);
  void settle_verdicts();
  [[nodiscard]] ilk_snapshot_t snapshot() const;
  [[nodiscard]] std::uint32_t ticks_of(double seconds) const;

  const Robot& robot_;
  ilk_config_t config_;
  plant::Plant plant_;
  Conductor conductor_;
  ilk_state_t state_{};
  ilk_outputs_t outputs_{};
  std::vector<ilk_request_t> requests_;
  std::vector<Sent> sent_;
  std::uint32_t sequence_ = 0;
  std::uint32_t proposal_ = 0;
};

}  // namespace interlock
