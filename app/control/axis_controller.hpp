/**
 * @file
 * The controller of one axis, from what a snapshot shows of it to the drive of the next MOVE.
 *
 * Far from the target it is the velocity-regulated controller that follows setpoints; within the deadband of
 * the target it wants no drive, as the kernel gives none. It always aims at the target of the whole move,
 * never at a setpoint on the way: an axis that is ahead waits without drive.
 */
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "control/control_error.hpp"
#include "control/drive_map.hpp"
#include "control/piv_controller.hpp"
#include "control/setpoint.hpp"
#include "control/velocity_estimator.hpp"
#include "interlock/types.h"
#include "robot/robot.hpp"

namespace interlock {

/** Everything particular to an axis. */
struct AxisControlRules {
  std::uint32_t period_us = 1000;
  std::uint32_t deadband_counts = 0;
  VelocityRules velocity;
  PivRules piv;
  DriveMapRules drive;
};

/**
 * Rules for an axis of a robot file, and the speed that the file lacks.
 *
 * - `full_speed_counts_per_s`: at the largest drive, from a data sheet or a run; it makes the feed-forward. A
 *   high-frequency axis in rad takes it from the published map instead.
 * - Lead: the coasting distance, which contains the latency of the loop, less backlash and noise, at full
 *   speed.
 * - Smallest drive: the file's; where that leaves it open, a 32nd of the way from the dead zone to the
 *   largest.
 * - Rate: full speed in 50 ms. Integral: at most half of full speed.
 */
AxisControlRules control_rules(const Axis& axis, std::uint32_t period_us, double full_speed_counts_per_s);

/** Speed at the largest drive as the robot file and the published map give it; nothing for other cards. */
std::optional<double> mapped_full_speed(const Axis& axis);

/** What the controller says in a tick. */
struct AxisOutput {
  std::uint32_t drive = 0; /**< for the next MOVE */
  PivOutput piv;
  std::optional<VelocityEstimate> velocity;
  std::optional<ControlError> error; /**< then the drive is zero */
};

/** From setpoint and reading to the drive word of one axis, tick by tick. */
class AxisController {
 public:
  /** Refused for rules that the velocity estimate, the PIV law or the drive map refuses. */
  static ControlResult<AxisController> create(const AxisControlRules& rules) noexcept;

  /**
   * One control tick. `axis` and `tick` are those of a snapshot, `setpoint` is for the time of that tick,
   * `target_counts` where the move ends, `ceiling_drive` the largest drive that the move may have now: that
   * of the order, or of an axis that is not homed.
   */
  AxisOutput update(const ilk_axis_t& axis, std::uint32_t tick, const Setpoint& setpoint,
                    std::int32_t target_counts,
                    std::uint32_t ceiling_drive = std::numeric_limits<std::uint32_t>::max()) noexcept;

  /** Follows the velocity of an axis that is not driven, so that it is known when a move begins. */
  void observe(const ilk_axis_t& axis, std::uint32_t tick) noexcept;

  /** As the readings so far tell it; nothing until there are enough of them. */
  [[nodiscard]] std::optional<VelocityEstimate> velocity() const noexcept { return estimator_.estimate(); }

 private:
  AxisController(const AxisControlRules& rules, const PivController& piv, const DriveMap& map) noexcept
      : rules_(rules), estimator_(rules.velocity), piv_(piv), map_(map) {}

  [[nodiscard]] double elapsed_s(std::uint32_t tick) const noexcept;

  AxisControlRules rules_;
  VelocityEstimator estimator_;
  PivController piv_;
  DriveMap map_;
  std::optional<std::uint32_t> last_tick_;
  std::uint32_t last_drive_ = 0;
};

}  // namespace interlock
