/**
 * @file
 * Identification: one axis moves to and fro for as long as the pedal is held, and what its mechanics do is
 * measured from its readings (tuning/axis_measurement.hpp).
 *
 * Where the pedal is released, the move that was under way is made and measured again.
 */
#pragma once

#include <array>
#include <cstdint>

#include "motion/held_mode.hpp"
#include "motion/setpoint_lease.hpp"
#include "tuning/axis_measurement.hpp"

namespace interlock {

/** See the top of this file. */
class IdentificationMode final : public HeldMode {
 public:
  explicit IdentificationMode(const RobotPlan& plan);

  void report(ControlView& view) const noexcept override;
  void on_unsent(const KernelRequest& request) noexcept override;
  void hold_insertion(bool held) noexcept override { insertion_held_ = held; }

 private:
  [[nodiscard]] std::uint32_t prepare(std::uint32_t tick) noexcept override;
  void begin(const ilk_snapshot_t& snapshot) noexcept override;
  void go_on(const ilk_snapshot_t& snapshot) noexcept override;
  void drive(const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept override;

  const RobotPlan plan_;
  AxisMeasurement measurement_;
  std::uint32_t slot_ = 0;
  bool insertion_held_ = false;
  MeasuringMove desired_;
  std::array<SetpointLease, ILK_SLOTS> leases_{};
};

}  // namespace interlock
