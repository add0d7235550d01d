/**
 * @file
 * What the robot touches: told where the axes are, it presses on the force sensors.
 */
#ifndef INTERLOCK_PLANT_SURROUNDINGS_HPP
#define INTERLOCK_PLANT_SURROUNDINGS_HPP

#include <array>
#include <optional>
#include <span>

#include "plant/parameters.hpp"

namespace interlock::plant {

/** Positions of the tool by slot, in counts; 0 where there is no axis. */
using AxisPositions = std::array<double, ILK_SLOTS>;

/** By so much the analog input of a sensor card reads more. */
struct SensorLoad {
  std::size_t slot = 0;
  std::size_t input = 0;
  std::int32_t counts = 0;
};

/** What a scanner showed, in the guide frame of scene.hpp. */
struct TipImage {
  double time_s = 0.0; /**< of its exposure, plant time */
  std::array<double, 3> tip_mm{};
  std::array<double, 3> target_mm{};
};

/** The truth, for a bench to show and a test to hold against. */
struct NeedleTruth {
  double depth_mm = 0.0; /**< of the insertion below the skin; below 0 in front of it */
  std::array<double, 3> tip_mm{};
  std::array<double, 3> target_mm{};
  double hand_n = 0.0;
  double needle_n = 0.0;
  std::span<const double> punctures_mm; /**< depths at which membranes tore, in their order */
};

class Surroundings {
 public:
  virtual ~Surroundings() = default;

  /** So much time passed, and the axes stand there now. */
  virtual void advance(const AxisPositions& counts, Microseconds elapsed) noexcept = 0;

  /** What presses on the sensors now. */
  virtual std::span<const SensorLoad> loads() const noexcept = 0;

  /** The surgeon presses with that force, N; 0 lets go. */
  virtual void press_hand(double force_n) noexcept = 0;

  /** The target moves by so much. */
  virtual void shift_target(const std::array<double, 3>& by_mm) noexcept = 0;

  /** The newest image that has arrived; nothing before the first. */
  virtual const std::optional<TipImage>& newest_image() const noexcept = 0;

  virtual NeedleTruth truth() const noexcept = 0;
};

}  // namespace interlock::plant

#endif
