/**
 * @file
 * Cooperative Biopsy: the surgeon's hand on the force sensor pushes the needle, for as long as the pedal is
 * held; the needle turns towards its target, and trembles for a moment when it has punctured a membrane.
 *
 * A press of the pedal follows the hand only once the hand has let go: what the sensor tells before is a zero
 * that is wrong, or a hand that does not know of the press.
 *
 * Nor does it follow the hand while the newest images contradict what is believed of tip or target: where the
 * needle is, or has to go, is not known well enough then. It goes on once newer ones agree again and the hand
 * has let go.
 *
 * The force is never acted upon for longer than 20 ms: after 8 ms without a new reading the task ends, and a
 * MOVE holds for 10 ms at most, so that an app that falls silent keeps that promise as well. Every error of
 * force or steering ends the task for both axes, which give back their drive.
 */
#pragma once

#include <cstdint>
#include <optional>

#include "motion/axis_tracker.hpp"
#include "motion/biopsy_run.hpp"
#include "motion/force_watch.hpp"
#include "motion/held_mode.hpp"

namespace interlock {

class BiopsyMode final : public HeldMode {
 public:
  explicit BiopsyMode(const RobotPlan& plan);

  /** An image of tip and target; one that cannot be is counted and changes nothing. */
  void see(const SeenImage& seen) noexcept override;
  void hold_insertion(bool held) noexcept override { insertion_held_ = held; }
  void report(ControlView& view) const noexcept override;

  void tick(const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept override;
  void on_unsent(const KernelRequest& request) noexcept override;
  [[nodiscard]] std::optional<Setpoint> setpoint(std::uint32_t slot) const noexcept override;

  [[nodiscard]] const BiopsyFindings& findings() const noexcept { return findings_; }
  [[nodiscard]] const BiopsyNow& now() const noexcept { return now_; }
  [[nodiscard]] const ForceReadings& force() const noexcept { return force_.readings(); }

 private:
  /** One axis along a speed that is decided tick by tick. */
  struct Guided {
    AxisTracker tracker;
    MotionRates rates;
    double counts_per_unit = 1.0;
    double position = 0.0; /**< in the axis' unit, as are those below */
    double speed = 0.0;
    PathPoint point;

    void start(const ilk_snapshot_t& snapshot, std::uint32_t slot) noexcept;
    /** Approaches the wanted speed within the rates of the axis. */
    void go(double desired, double time_s) noexcept;
    void aim(double offset, double offset_speed, double lease_s) noexcept;
  };

  /** A robot without a needle aborts it. */
  [[nodiscard]] std::uint32_t prepare(std::uint32_t tick) noexcept override;
  void begin(const ilk_snapshot_t& snapshot) noexcept override;
  void go_on(const ilk_snapshot_t& snapshot) noexcept override;
  void drive(const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept override;
  [[nodiscard]] bool plan_steering(const ilk_snapshot_t& snapshot) noexcept;
  [[nodiscard]] bool push(const ilk_snapshot_t& snapshot, double time_s) noexcept;
  [[nodiscard]] bool listen(const ilk_snapshot_t& snapshot, std::uint32_t ticks) noexcept;
  [[nodiscard]] bool fails(const KinematicsError& error, std::uint32_t tick) noexcept;
  [[nodiscard]] double depth_mm(const ilk_snapshot_t& snapshot) const noexcept;

  const std::optional<NeedlePlan> needle_;
  const double period_s_;
  const std::uint32_t force_timeout_ticks_;
  const std::uint32_t steering_ticks_;
  const double lease_s_;
  ForceWatch force_;
  BiopsyRun* run_ = nullptr; /**< of the newest task */
  BiopsyFindings findings_;
  BiopsyNow now_;
  Guided insertion_;
  Guided rotation_;
  SteeringCommand command_;
  double deepest_allowed_mm_ = 0.0; /**< position of the insertion */
  double cue_mm_ = 0.0;
  bool let_go_ = false; /**< the hand has, since the press */
  bool insertion_held_ = false;
  std::uint32_t seen_tick_ = 0;    /**< of the snapshot before, while executing */
  std::uint32_t steered_tick_ = 0; /**< of the newest plan */
};

}  // namespace interlock
