/**
 * @file
 * A whole robot in this process: the modes of the app, the kernel core and the simulated plant, tick by tick,
 * far faster than real time. No other process, socket or clock takes part; a scripted foot holds the pedal.
 */
#pragma once

#include <cstdint>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "closed_loop.hpp"
#include "motion_record.hpp"
#include "targeting/robot_kinematics.hpp"

namespace interlock {

/** A value, or what went wrong, for people. */
template <typename Value>
using DemoResult = tl::expected<Value, std::string>;

/** How a needle that a hand pushed ended. */
struct NeedleInsertion {
  Eigen::Vector3d tip_mm = Eigen::Vector3d::Zero(); /**< true, in the guide frame */
  double depth_mm = 0.0;                            /**< true */
  std::vector<double> punctures_mm;                 /**< depths at which membranes truly tore */
  std::vector<double> found_mm;                     /**< depths at which the app noticed one */
  std::uint32_t images = 0;                         /**< of the tip, that the compensation took */
};

/** Kernel core and plant in this process, driven as the app drives them. */
class RobotRig {
 public:
  /** Unlocked; `robot` must outlive it. */
  RobotRig(const Robot& robot, const plant::Parameters& parameters, std::uint64_t seed);

  /** Declares the home of axes without a switch, enables all and homes the rest in the file's order.
   */
  DemoResult<void> make_ready();

  /** Carries out a program with the pedal held; the error says which axis ended it and why. */
  DemoResult<void> carry_out(const PathProgram& program);

  /**
   * Has a hand push the needle to a target in the guide frame (motion/biopsy_run.hpp), through tissue that no
   * needle has been in: membranes and scanner are those of the plant's file, which must have a needle, and
   * images are handed on as they come. The pedal is held.
   */
  DemoResult<NeedleInsertion> take_biopsy(const Eigen::Vector3d& target_mm, std::uint64_t tissue_seed);

  /** What the axes did in the newest motion, every 5 ms. */
  [[nodiscard]] const MotionRecord& record() const { return record_; }

  /** Where the axes are as the kernel reads them, in their units and order. */
  [[nodiscard]] AxisPositions positions() const;

  /** How far an axis with a switch truly is from where the kernel reads it, at most, beyond the count that a
   * reading leaves open. */
  [[nodiscard]] double homing_counts() const;

  /** Where the tools of the axes truly are, in their units and order: what a scan would show. */
  [[nodiscard]] AxisPositions true_positions() const;

  /** Simulated time. */
  [[nodiscard]] double time_s() const { return tick() * tick_s(); }

 private:
  DemoResult<void> home();
  DemoResult<BiopsyRun> begin_biopsy(const Eigen::Vector3d& target_mm);
  void follow_biopsy(std::uint32_t start_tick, std::uint32_t scene_tick);
  void begin_task(Work work);
  [[nodiscard]] TaskStatus status() const;
  [[nodiscard]] bool goes_on(std::uint32_t since_tick) const;
  DemoResult<void> end_task();
  void begin_record();
  void note();
  [[nodiscard]] std::uint32_t tick() const { return loop_.state().system.tick; }
  [[nodiscard]] double tick_s() const;
  [[nodiscard]] std::uint32_t ticks_of(double seconds) const;

  const Robot& robot_;
  plant::Parameters parameters_;
  test::ClosedLoop loop_;  /**< without latency */
  std::uint32_t task_ = 0; /**< the newest */
  const std::type_info* kind_ = &typeid(HomeTask);
  MotionRecord record_;
  std::uint32_t record_tick_ = 0; /**< at which the newest motion was ordered */
};

}  // namespace interlock
