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

TEST(InnovationWatch, OneWildPointSaysNothingAndTwoDoUntilSomeAgreeAgain) {
  InnovationWatch watch;
  EXPECT_FALSE(watch.add(1e9));
  EXPECT_TRUE(watch.add(1e9));
  for (std::size_t n = 0; n < InnovationWatch::agreeing; ++n) {
    EXPECT_TRUE(watch.disagrees());
    EXPECT_FALSE(watch.add(3.0));
  }
  EXPECT_FALSE(watch.disagrees());
}

TEST(InnovationWatch, ATargetThatJumpsIsFoundAnewAndAgreesThere) {
  const Eigen::Vector3d planned(0.0, 0.0, 70.0);
  const Eigen::Vector3d jumped(4.0, -3.0, 70.0);
  TargetFilter target = TargetFilter::create({}, planned, 0.0).value();
  double time_s = 0.0;
  for (int image = 0; image < 10; ++image) {
    ASSERT_TRUE(target.see(time_s += 2.0, planned));
    ASSERT_FALSE(target.images_disagree());
  }
  ASSERT_TRUE(target.see(time_s += 2.0, jumped));
  ASSERT_TRUE(target.see(time_s += 2.0, jumped));
  EXPECT_TRUE(target.images_disagree());
  EXPECT_LT((target.target_mm() - jumped).norm(), 0.1);
  for (std::size_t image = 0; image < InnovationWatch::agreeing; ++image) {
    ASSERT_TRUE(target.images_disagree());
    ASSERT_TRUE(target.see(time_s += 2.0, jumped));
  }
  EXPECT_FALSE(target.images_disagree());
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
