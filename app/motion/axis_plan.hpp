/**
 * @file
 * What the control thread knows of the robot: axes by slot and home steps, copied once, never changed.
 */
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "control/axis_controller.hpp"
#include "interlock/types.h"
#include "motion/force_watch.hpp"
#include "robot/robot.hpp"

namespace interlock {

/** The kernel's rules for an axis and what a controller needs to know besides. */
struct AxisPlan {
  ilk_axis_config_t rules{};
  DriveBounds drive;
  double counts_per_unit = 1.0;
  MotionRates rates;        /**< all zero: the axis moves alone only */
  AxisControlRules control; /**< along a path; without rates they make no controller */
};

/** How the axes of a home step go. */
enum class HomeStepKind : std::uint8_t {
  home,  /**< to their switches */
  nudge, /**< by signed distances, homed or not */
  move   /**< to positions */
};

/** A home step with a fixed size. */
class HomeStepPlan {
 public:
  /** No axis. */
  HomeStepPlan() = default;

  /** One axis at its switch. */
  explicit HomeStepPlan(std::uint32_t slot) noexcept { add({slot, 0}); }

  explicit HomeStepPlan(const HomeStep& step) noexcept {
    for (const std::uint32_t slot : step.home) {
      add({slot, 0});
    }
    for (const AxisCounts& each : step.nudge) {
      kind_ = HomeStepKind::nudge;
      add(each);
    }
    for (const AxisCounts& each : step.move) {
      kind_ = HomeStepKind::move;
      add(each);
    }
  }

  [[nodiscard]] HomeStepKind kind() const noexcept { return kind_; }

  /** Each slot at most once. */
  [[nodiscard]] std::span<const AxisCounts> axes() const noexcept { return {axes_.data(), count_}; }

  /** Bit n: the step moves the axis in slot n. */
  [[nodiscard]] std::uint32_t mask() const noexcept { return mask_; }

 private:
  void add(const AxisCounts& axis) noexcept {
    const std::uint32_t bit = axis.slot < ILK_SLOTS ? 1u << axis.slot : 0u;
    if ((mask_ | bit) != mask_) {
      axes_[count_++] = axis;
      mask_ |= bit;
    }
  }

  HomeStepKind kind_ = HomeStepKind::home;
  std::array<AxisCounts, ILK_SLOTS> axes_{};
  std::size_t count_ = 0;
  std::uint32_t mask_ = 0;
};

/** The needle of a robot that takes biopsies. */
struct NeedlePlan {
  std::uint32_t insertion_slot = 0;
  std::uint32_t rotation_slot = 0;
  ForceInputs force;
};

/** The robot as the control thread sees it. A slot without a motor has `rules.max_drive == 0`. */
struct RobotPlan {
  std::array<AxisPlan, ILK_SLOTS> axis{};
  std::uint32_t period_us = 1000;
  std::uint32_t lease_max_ticks = 0;
  std::vector<HomeStepPlan> home_steps;
  std::optional<NeedlePlan> needle;
  std::optional<std::uint32_t> insertion_slot; /**< of what goes into the patient: deeper at more counts */

  RobotPlan(const Robot& robot, const ilk_config_t& config)
      : period_us(config.common.period_us),
        lease_max_ticks(config.common.lease_max_ticks),
        home_steps(robot.home_steps.begin(), robot.home_steps.end()) {
    const Axis* insertion = robot.with_role("insertion");
    const Axis* rotation = robot.with_role("rotation");
    insertion_slot = insertion == nullptr ? std::nullopt : std::optional(insertion->slot);
    if (robot.biopsy && insertion != nullptr && rotation != nullptr) {
      const Biopsy& biopsy = *robot.biopsy;
      needle = NeedlePlan{
          insertion->slot, rotation->slot, {biopsy.sensor_slot, biopsy.hand.adc, biopsy.needle.adc}};
    }
    for (const Axis& each : robot.axes) {
      const MotionRates rates = each.motion.value_or(MotionRates{});
      axis[each.slot] =
          AxisPlan{config.axis[each.slot], each.drive, each.counts_per_unit, rates,
                   control_rules(each, config.common.period_us, each.mechanics.full_speed_counts_per_s)};
    }
  }

  [[nodiscard]] double period_s() const noexcept { return static_cast<double>(period_us) * 1e-6; }

  /** Lease of a move: short, so that a silent app stops early. */
  [[nodiscard]] std::uint32_t lease_ticks() const noexcept {
    constexpr std::uint32_t longest = 50;
    return std::clamp(lease_max_ticks, 1u, longest);
  }

  /** How long a task may wait without executing. */
  [[nodiscard]] std::uint32_t timeout_ticks() const noexcept {
    constexpr std::uint32_t minute_us = 60'000'000;
    return minute_us / std::max(1u, period_us);
  }

  /** How long a task may wait for a confirmation: somebody may have to make an image first. */
  [[nodiscard]] std::uint32_t confirmation_ticks() const noexcept { return 10 * timeout_ticks(); }
};

/** How far an axis may stand from where it came to rest and still count as standing there. */
constexpr std::uint32_t rest_tolerance_counts(const ilk_axis_config_t& rules) noexcept {
  return 3 * rules.deadband_counts;
}

/** Whether a card of this kind drives a motor. */
constexpr bool drives_motor(std::uint32_t card) noexcept {
  return card != ILK_CARD_NONE && card != ILK_CARD_SENSOR;
}

}  // namespace interlock
