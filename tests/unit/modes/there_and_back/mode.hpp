/**
 * @file
 * A whole small mode: one axis by a distance and back again.
 */
#pragma once

#include "motion/axis_move.hpp"
#include "motion/held_mode.hpp"

namespace interlock {

/** To a distance from where the axis is when the pedal is pressed first, and back. */
struct ThereAndBackTask {
  std::uint32_t slot = 0;
  std::int32_t by_counts = 0;
};

class ThereAndBackMode final : public HeldMode {
 public:
  explicit ThereAndBackMode(const RobotPlan& plan);

  void on_unsent(const KernelRequest& request) noexcept override;

 private:
  [[nodiscard]] std::uint32_t prepare(std::uint32_t tick) noexcept override;
  void begin(const ilk_snapshot_t& snapshot) noexcept override;
  void go_on(const ilk_snapshot_t& snapshot) noexcept override;
  void drive(const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept override;

  std::array<AxisMove, ILK_SLOTS> moves_;
  std::optional<std::int32_t> start_counts_;
};

}  // namespace interlock
