/**
 * @file
 * Manual mode: each axis goes to its own setpoint for as long as the pedal is held.
 *
 * A move is carried by leases: it is renewed while the pedal is held and stops by itself when it is not.
 * Times count kernel ticks, so that the simulated clock behaves as the real one.
 */
#pragma once

#include <array>
#include <cstdint>

#include "interlock/link.h"
#include "motion/axis_plan.hpp"
#include "motion/mode.hpp"

namespace interlock {

class ManualMode final : public Mode {
 public:
  explicit ManualMode(const RobotPlan& plan) noexcept;

  void take(const Order& order, std::uint32_t tick) noexcept override;
  void end(std::uint32_t slot, std::uint32_t proposal, OrderReason reason,
           std::uint32_t tick) noexcept override;
  void end_all(OrderReason reason, std::uint32_t tick) noexcept override;
  [[nodiscard]] MoveWishes tick(const ilk_snapshot_t& snapshot) noexcept override;
  void on_unsent(const MoveWish& wish) noexcept override;
  void on_verdict(std::uint32_t slot, std::uint32_t proposal, std::uint32_t verdict,
                  std::uint32_t tick) noexcept override;
  [[nodiscard]] const OrderTable& orders() const noexcept override { return orders_; }

 private:
  /** What the mode remembers of an axis besides its order's status. */
  struct Job {
    Order order;
    bool holds_lease = false;         /**< a MOVE was sent that may still drive the axis */
    std::uint32_t sent_tick = 0;      /**< of the newest MOVE */
    std::uint32_t sent_drive = 0;     /**< of the newest MOVE */
    std::uint32_t idle_since = 0;     /**< tick since which the order does not execute */
    std::int32_t rest_position = 0;   /**< about which the axis rests */
    std::uint32_t rest_since = 0;     /**< tick since which it rests within the deadband */
    std::uint32_t unblocked_tick = 0; /**< newest tick in which no limit held the axis back */
  };

  void set_phase(std::uint32_t slot, OrderPhase phase, OrderReason reason, std::uint32_t code,
                 std::uint32_t tick) noexcept;
  void judge(std::uint32_t slot, const ilk_snapshot_t& snapshot) noexcept;
  void pause_or_expire(std::uint32_t slot, const ilk_snapshot_t& snapshot) noexcept;
  void follow(std::uint32_t slot, const ilk_snapshot_t& snapshot) noexcept;
  [[nodiscard]] bool at_rest_on_target(std::uint32_t slot, const ilk_snapshot_t& snapshot) noexcept;
  [[nodiscard]] bool held_back(std::uint32_t slot, const ilk_snapshot_t& snapshot) noexcept;
  [[nodiscard]] std::uint32_t wanted_drive(std::uint32_t slot, const ilk_axis_t& axis) const noexcept;
  [[nodiscard]] MoveWish wish_for(std::uint32_t slot, std::uint32_t drive,
                                  std::uint32_t lease_ticks) const noexcept;

  const RobotPlan plan_;
  const std::uint32_t lease_ticks_;
  const std::uint32_t patience_ticks_;
  std::array<Job, ILK_SLOTS> jobs_{};
  OrderTable orders_{};
};

}  // namespace interlock
