/**
 * @file
 * What a plot needs of each tick, thirty times a second: the least and the greatest value of every tick in
 * between, so that no peak is lost however short it was.
 */
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "control/velocity_estimator.hpp"
#include "interlock/link.h"
#include "motion/axis_plan.hpp"
#include "motion/force_watch.hpp"

namespace interlock {

/** The ends of what a quantity was; none before the first value. */
template <typename Number>
class Extremes {
 public:
  /** Widens them so that the value is between them. */
  void add(Number value) noexcept {
    least_ = known_ && least_ < value ? least_ : value;
    greatest_ = known_ && greatest_ > value ? greatest_ : value;
    known_ = true;
  }

  [[nodiscard]] bool known() const noexcept { return known_; }
  [[nodiscard]] Number least() const noexcept { return least_; }
  [[nodiscard]] Number greatest() const noexcept { return greatest_; }

 private:
  Number least_{};
  Number greatest_{};
  bool known_ = false;
};

/** Of one axis: of those ticks that have the quantity. */
struct AxisExtremes {
  Extremes<std::int32_t> position_counts;           /**< of valid frames */
  Extremes<std::int32_t> setpoint_counts;           /**< while MOVING */
  Extremes<std::int32_t> error_counts;              /**< setpoint less position, where both are there */
  Extremes<float> velocity_counts_per_s;            /**< of the last 20 ms, by the card's clock */
  Extremes<std::int32_t> drive;                     /**< that left the kernel's gate; negative: decreasing */
  std::optional<std::int32_t> last_position_counts; /**< as `position_counts`, in the newest tick */
  std::optional<std::int32_t> last_setpoint_counts; /**< as `setpoint_counts`, in the newest tick */
  double error_squares = 0.0;                       /**< sum of the squares of `error_counts` */
  std::uint32_t error_ticks = 0;                    /**< that have an error */
};

/** Some ticks in a row, as far as they were seen. */
struct TickBucket {
  std::uint32_t run = 0;       /**< grows when the ticks begin anew: another kernel, or a state made anew */
  std::uint32_t last_tick = 0; /**< newest one that was seen */
  std::uint32_t ticks = 0;     /**< that were seen */
  std::array<AxisExtremes, ILK_SLOTS> axis{};
  Extremes<std::uint32_t> hand_counts; /**< of the force sensor's converter; robots with a needle */
  Extremes<std::uint32_t> needle_counts;
};

/** The time that a bucket covers. */
constexpr std::uint32_t bucket_us = 33'000;

/** Ticks of a bucket at that period; a bucket ends with each multiple of them. */
constexpr std::uint32_t ticks_of_bucket(std::uint32_t period_us) noexcept {
  return period_us == 0 || period_us > bucket_us ? 1 : bucket_us / period_us;
}

/** Belongs to the control thread; allocates only when it is made. */
class Decimation {
 public:
  explicit Decimation(const RobotPlan& plan);

  /** Takes in a tick of the attachment of that generation; the bucket before, when the tick begins another
   * one. */
  [[nodiscard]] std::optional<TickBucket> take(std::uint32_t generation, const ilk_snapshot_t& snapshot,
                                               const ForceReadings& force) noexcept;

 private:
  [[nodiscard]] bool begins_anew(std::uint32_t generation, std::uint32_t tick) const noexcept;
  void add_axis(std::uint32_t slot, const ilk_snapshot_t& snapshot) noexcept;

  std::uint32_t length_;
  std::vector<std::uint32_t> slots_;          /**< of the motors */
  std::vector<VelocityEstimator> estimators_; /**< of each of them */
  std::uint32_t generation_ = 0;
  TickBucket bucket_;
};

}  // namespace interlock
