/** @file The workspace is sampled the same way each time, within bounds, and counts what it cannot reach. */
#include "kinematics/workspace.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "robots.hpp"

namespace interlock::test {
namespace {

struct Range {
  std::vector<double> lowest;
  std::vector<double> highest;
};

const Range neuro_range{{-145, -70, -49.47, 0, -6.28, -0.465, -1.536},
                        {0, 75.01, 0, 34.93, 6.28, 0.648, 0.010}};
const Range prostate_range{{40, -188.89, 40, -185.39, 0, -3}, {188.89, -40, 187.39, -40, 168, 3}};

KinematicsResult<Workspace> sampled(const Kinematics& kinematics, const Range& range, std::size_t count,
                                    std::uint64_t seed) {
  return sample_workspace(kinematics, range.lowest, range.highest, count, seed);
}

TEST(Workspace, same_seed_gives_the_same_samples_and_another_seed_others) {
  const auto first = sampled(neuro(), neuro_range, 500, 42);
  const auto again = sampled(neuro(), neuro_range, 500, 42);
  const auto other = sampled(neuro(), neuro_range, 500, 43);
  EXPECT_EQ(first->zframe_mm, again->zframe_mm);
  EXPECT_NE(first->zframe_mm.front(), other->zframe_mm.front());
}

TEST(Workspace, each_draw_is_a_sample_or_counted_as_refused) {
  const auto neuro_space = sampled(neuro(), neuro_range, 5000, 1);
  EXPECT_EQ(neuro_space->zframe_mm.size() + neuro_space->refused, 5000U);
  EXPECT_GT(neuro_space->refused, 0U);
  const auto prostate_space = sampled(prostate(), prostate_range, 5000, 1);
  EXPECT_EQ(prostate_space->zframe_mm.size() + prostate_space->refused, 5000U);
  EXPECT_FALSE(prostate_space->zframe_mm.empty());
}

TEST(Workspace, samples_are_in_the_zframe_and_within_the_bounds) {
  const auto space = *sampled(prostate(), prostate_range, 2000, 3);
  for (const Eigen::Vector3d& point : space.zframe_mm) {
    EXPECT_TRUE(space.bounds.contains(point));
  }
  // A range of one place is that place.
  const std::vector<double> home{150, -150, 150, -150, 0, 0};
  const auto place = *sampled(prostate(), {home, home}, 1, 1);
  ASSERT_EQ(place.zframe_mm.size(), 1U);
  EXPECT_EQ(place.zframe_mm.front(), prostate().zframe_from_treatment(home)->translation());
}

TEST(Workspace, without_a_reachable_joint_is_empty) {
  const auto space = *sampled(neuro(), {{50, 0, 0, 0, 0, 0, 0}, {60, 0, 0, 0, 0, 0, 0}}, 100, 1);
  EXPECT_TRUE(space.zframe_mm.empty());
  EXPECT_EQ(space.refused, 100U);
  EXPECT_TRUE(space.bounds.isEmpty());
}

TEST(Workspace, bad_range_or_count_is_refused_by_name) {
  Range upside_down = neuro_range;
  std::swap(upside_down.lowest[6], upside_down.highest[6]);
  EXPECT_EQ(sampled(neuro(), upside_down, 10, 1).error().quantity, "yaw_rad");
  Range not_finite = prostate_range;
  not_finite.highest[4] = std::nan("");
  EXPECT_EQ(sampled(prostate(), not_finite, 10, 1).error().quantity, "insertion_mm");
  EXPECT_EQ(sampled(neuro(), neuro_range, largest_sample_count + 1, 1).error().quantity, "sample_count");
}

}  // namespace
}  // namespace interlock::test
