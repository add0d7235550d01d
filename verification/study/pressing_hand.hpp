/**
 * @file
 * From a hand's force to the speed of the needle: sensor with noise, its zeroing, and the cooperative law.
 */
#pragma once

#include <cstdint>

#include "needle/hand.hpp"
#include "plant/force_sensor.hpp"
#include "steering/cooperative_insertion.hpp"
#include "steering/force_calibration.hpp"

namespace interlock::experiment {

inline constexpr double period_s = 0.001;

/** No insertion goes on for longer. */
inline constexpr double longest_s = 300.0;

/** Streams of one seed, one for each part of the world, so that they do not disturb each other. */
enum Stream : std::uint64_t { world = 1, hand, sensor, tissue, image };

/** The published channels (models/robots/prostate.toml). */
SensorChannel hand_channel();
SensorChannel needle_channel();

/** A gram-force: our reading of the published slope, whose unit nobody states. */
inline constexpr double units_per_newton = 1000.0 / 9.80665;

/** A force sensor of the plant, and the app's calibration of it, zeroed before the needle moves. */
class SensedForce {
 public:
  SensedForce(const SensorChannel& channel, std::uint32_t noise_counts, const plant::Random& noise);

  /** What the app believes of a force of so many newtons. */
  double sense(double force_n);

 private:
  std::uint32_t read(double force_n);

  SensorChannel channel_;
  std::size_t input_;
  plant::ForceSensor sensor_;
  ForceCalibration calibration_;
};

/** A hand on the input sensor. */
class PressingHand {
 public:
  PressingHand(std::uint64_t seed, std::uint32_t noise_counts);

  /** Wanted speed of the insertion in this period, mm/s, with so much left to the setpoint. */
  double speed_mm_s(double left_mm);

 private:
  needle::Hand hand_;
  SensedForce force_;
};

}  // namespace interlock::experiment
