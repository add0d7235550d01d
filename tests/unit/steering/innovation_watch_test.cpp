#include "steering/innovation_watch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "steering_experiment.hpp"

namespace interlock {
namespace {

using experiment::insert;
using experiment::Steering;
using experiment::SteeringOutcome;
using experiment::SteeringWorld;

constexpr std::uint64_t insertions = 24;

/** How many of them were flagged. */
template <typename Change>
std::uint64_t flagged(Change change) {
  SteeringWorld world;
  change(world);
  std::uint64_t count = 0;
  for (std::uint64_t seed = 1001; seed < 1001 + insertions; ++seed) {
    count += insert(world, Steering::averaged, seed).flagged ? 1 : 0;
  }
  return count;
}

TEST(InnovationWatch, PointsThatScatterAsTheyAreSaidToDisagreeOnceInThousandsOfWindows) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> coordinate;
  InnovationWatch watch;
  int disagreements = 0;
  for (int n = 0; n < 20'000; ++n) {
    double squared = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      squared += std::pow(coordinate(random), 2);
    }
    watch.add(squared);
    disagreements += watch.disagrees() ? 1 : 0;
  }
  EXPECT_LE(disagreements, 10);
}

TEST(InnovationWatch, OneWildPointSaysNothingTwoDoUntilTheWindowHasPassed) {
  InnovationWatch watch;
  watch.add(1e9);
  EXPECT_FALSE(watch.disagrees());
  watch.add(1e9);
  EXPECT_TRUE(watch.disagrees());
  for (std::size_t n = 1; n < InnovationWatch::window; ++n) {
    watch.add(3.0);
  }
  EXPECT_FALSE(watch.disagrees());
}

TEST(InnovationWatch, AnInsertionAsItIsBelievedToBeIsNotFlagged) {
  EXPECT_EQ(flagged([](SteeringWorld&) {}), 0u);
  EXPECT_EQ(flagged([](SteeringWorld& world) { world.curvature_per_mm = 0.0022; }), 0u);
}

TEST(InnovationWatch, BreathingADraggedTargetAndImagesThatAreWorseThanStatedAreFlagged) {
  EXPECT_EQ(flagged([](SteeringWorld& world) { world.imager.breathing_mm = 3.0; }), insertions);
  EXPECT_EQ(flagged([](SteeringWorld& world) { world.dragged_share = 0.08; }), insertions);
  EXPECT_EQ(flagged([](SteeringWorld& world) { world.imager.deviation_mm = 1.0; }), insertions);
}

}  // namespace
}  // namespace interlock
