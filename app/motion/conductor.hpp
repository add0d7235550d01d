/**
 * @file
 * The modes together: hands each order to its mode and sees to it that only one mode has open orders.
 */
#pragma once

#include <cstdint>
#include <optional>

#include "motion/biopsy_mode.hpp"
#include "motion/home_mode.hpp"
#include "motion/manual_mode.hpp"
#include "motion/path_mode.hpp"
#include "motion/sweep_mode.hpp"

namespace interlock {

class Conductor {
 public:
  explicit Conductor(const RobotPlan& plan)
      : manual_(plan), home_(plan), path_(plan), sweep_(plan), biopsy_(plan) {}

  /** Takes a move; while homing or another mode is open it is ended at once. */
  void take(const Order& order, std::uint32_t tick) noexcept;

  /** Takes homing; whatever else is open ends. */
  void take(const HomeOrder& order, std::uint32_t tick) noexcept;

  /** Takes a path; whatever else is open ends. */
  void take(const PathOrder& order, std::uint32_t tick) noexcept;

  /** Takes a sweep; whatever else is open ends. */
  void take(const SweepOrder& order, std::uint32_t tick) noexcept;

  /** Takes a biopsy; whatever else is open ends. */
  void take(const BiopsyOrder& order, std::uint32_t tick) noexcept;

  /** An image for the open biopsy. */
  void see(const SeenImage& seen) noexcept { biopsy_.see(seen); }

  /** Aborts the order of that proposal, if it is open. */
  void end(std::uint32_t proposal, OrderReason reason, std::uint32_t tick) noexcept;

  /** Aborts the open order that moves the axis in `slot`, if there is one. */
  void end_axis(std::uint32_t slot, OrderReason reason, std::uint32_t tick) noexcept;

  /** Ends every open order for that reason. */
  void end_all(OrderReason reason, std::uint32_t tick) noexcept;

  /** The requests to send in this tick, first one first. */
  [[nodiscard]] Wishes tick(const ilk_snapshot_t& snapshot) noexcept;

  /** A request that the link did not take. */
  void on_unsent(const Wish& wish) noexcept;
  /** The kernel's answer to a request. */
  void on_verdict(const WishOrigin& origin, std::uint32_t verdict, std::uint32_t tick) noexcept;
  /** The kernel's answer to a request will never be known. */
  void on_verdict_lost(const WishOrigin& origin, std::uint32_t tick) noexcept;

  [[nodiscard]] const OrderTable& orders() const noexcept { return manual_.orders(); }
  [[nodiscard]] const HomeStatus& home() const noexcept { return home_.status(); }
  [[nodiscard]] const PathStatus& path() const noexcept { return path_.status(); }
  [[nodiscard]] const SweepStatus& sweep() const noexcept { return sweep_.status(); }
  /** Where a path or a biopsy wants the axis in `slot` now; nothing when neither moves it. */
  [[nodiscard]] std::optional<Setpoint> setpoint(std::uint32_t slot) const noexcept;

  [[nodiscard]] const BiopsyMode& biopsy() const noexcept { return biopsy_; }

 private:
  /** Every mode, homing last: the others give back their leases before it asks for their axes. */
  template <typename Work>
  void each_mode(Work work) noexcept {
    for (Mode* mode : {static_cast<Mode*>(&manual_), static_cast<Mode*>(&path_), static_cast<Mode*>(&sweep_),
                       static_cast<Mode*>(&biopsy_), static_cast<Mode*>(&home_)}) {
      work(*mode);
    }
  }

  ManualMode manual_;
  HomeMode home_;
  PathMode path_;
  SweepMode sweep_;
  BiopsyMode biopsy_;
};

}  // namespace interlock
