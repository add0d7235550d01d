/** @file Whole insertions on a few seeds; verification/study runs the study on all. */
#include <gmock/gmock.h>

#include <cmath>

#include "membrane_experiment.hpp"
#include "steering_experiment.hpp"

namespace interlock::test {
namespace {

using experiment::insert;
using experiment::Steering;
using experiment::SteeringOutcome;
using experiment::SteeringWorld;

double rms_mm(Steering steering, std::uint64_t first, std::uint64_t last, const SteeringWorld& world = {}) {
  double squared = 0.0;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    const SteeringOutcome outcome = insert(world, steering, seed);
    EXPECT_TRUE(outcome.arrived) << seed;
    squared += outcome.error_mm * outcome.error_mm;
  }
  return std::sqrt(squared / static_cast<double>(last - first + 1));
}

TEST(ActiveCompensation, misses_by_less_than_without_it_and_than_published) {
  const double averaged = rms_mm(Steering::averaged, 1, 10);
  EXPECT_LT(averaged, 3.56);
  EXPECT_LT(averaged, 0.5 * rms_mm(Steering::spinning, 1, 10));
  EXPECT_LT(averaged, 0.5 * rms_mm(Steering::still, 1, 10));
}

TEST(ActiveCompensation, makes_up_for_deflection_alone) {
  SteeringWorld world;
  world.least_shift_mm = 0.0;
  world.most_shift_mm = 0.0;
  EXPECT_LT(rms_mm(Steering::averaged, 1, 5, world), 1.5);
}

TEST(ActiveCompensation, needs_its_images) {
  SteeringWorld blind;
  blind.imager.age_s = 1e6;
  EXPECT_GT(rms_mm(Steering::averaged, 1, 5, blind), 2.0 * rms_mm(Steering::averaged, 1, 5));
}

TEST(ActiveCompensation, does_the_same_with_the_same_seed) {
  const SteeringOutcome first = insert({}, Steering::averaged, 3);
  const SteeringOutcome second = insert({}, Steering::averaged, 3);
  EXPECT_EQ(first.error_mm, second.error_mm);
  EXPECT_EQ(first.estimated_per_mm, second.estimated_per_mm);
  EXPECT_NE(first.error_mm, insert({}, Steering::averaged, 4).error_mm);
}

TEST(MembraneDetection, finds_punctures_by_a_pressing_hand_in_time) {
  std::uint32_t punctures = 0;
  std::uint32_t hits = 0;
  std::uint32_t false_alarms = 0;
  for (std::uint64_t seed = 1; seed <= 15; ++seed) {
    const experiment::MembraneOutcome outcome = experiment::pass_membranes({}, seed);
    punctures += outcome.punctures;
    hits += outcome.hits;
    false_alarms += outcome.false_alarms;
    for (const double latency_s : outcome.latencies_s) {
      EXPECT_LE(latency_s, experiment::latest_cue_s);
    }
  }
  EXPECT_GE(punctures, 30u);
  EXPECT_GE(hits, 0.9 * punctures);
  EXPECT_LE(false_alarms, 1u);
}

TEST(MembraneDetection, cues_nothing_where_there_is_no_membrane) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const experiment::MembraneOutcome outcome = experiment::pass_membranes({.absent = 1.0}, seed);
    EXPECT_EQ(outcome.punctures, 0u);
    EXPECT_EQ(outcome.false_alarms, 0u);
  }
}

}  // namespace
}  // namespace interlock::test
