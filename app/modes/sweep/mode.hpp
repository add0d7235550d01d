/**
 * @file
 * Frequency Sweep: one high-frequency axis turns at one frequency after the other, for as long as the pedal
 * is held, and its speed at each is measured.
 *
 * The axis goes to and fro between the ends of its range; before it turns round it comes to rest. Each
 * frequency lasts for its dwell in driven time: a pause, or turning round, is not counted. The kernel knows
 * drives, not frequencies, and refuses one beyond the axis' band.
 */
#pragma once

#include <array>
#include <cstdint>

#include "motion/held_mode.hpp"
#include "motion/rest_watch.hpp"
#include "motion/setpoint_lease.hpp"

namespace interlock {

class SweepMode final : public HeldMode {
 public:
  explicit SweepMode(const RobotPlan& plan);

  void report(ControlView& view) const noexcept override;
  void on_unsent(const KernelRequest& request) noexcept override;

 private:
  [[nodiscard]] std::uint32_t prepare(std::uint32_t tick) noexcept override;
  void begin(const ilk_snapshot_t& snapshot) noexcept override;
  void go_on(const ilk_snapshot_t& snapshot) noexcept override;
  void drive(const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept override;
  void measure(const ilk_axis_t& axis, std::uint32_t ticks) noexcept;
  void end_step(std::uint32_t tick) noexcept;
  [[nodiscard]] std::int32_t target_counts(const ilk_snapshot_t& snapshot) const noexcept;

  const RobotPlan plan_;
  const std::uint32_t settle_ticks_;
  SweepTask sweep_;
  SweepSpeeds speeds_{};
  std::array<SetpointLease, ILK_SLOTS> leases_{};
  RestWatch rest_;
  bool upwards_ = true;
  bool turning_ = false;             /**< without drive, until it rests */
  std::uint32_t seen_tick_ = 0;      /**< of the snapshot before, while executing */
  std::int32_t seen_counts_ = 0;     /**< position in it */
  std::uint32_t driven_ticks_ = 0;   /**< of this step */
  std::uint32_t steady_ticks_ = 0;   /**< since the axis began to go this way at this frequency */
  std::uint32_t measured_ticks_ = 0; /**< of this step, at steady speed */
  double measured_counts_ = 0.0;     /**< gone in them */
};

}  // namespace interlock
