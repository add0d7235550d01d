/** @file The workspace is sampled the same way each time, within bounds, and counts what it cannot reach. */
#include "kinematics/workspace.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "random_joints.hpp"
#include "robots.hpp"

namespace interlock::test {
namespace {

const JointRange<NeuroJoints> neuro_range{{-145, -70, -49.47, 0, -6.28, -0.465, -1.536},
                                          {0, 75.01, 0, 34.93, 6.28, 0.648, 0.010}};
const JointRange<ProstateJoints> prostate_range{{40, -188.89, 40, -185.39, 0, -3},
                                                {188.89, -40, 187.39, -40, 168, 3}};

TEST(Workspace, same_seed_gives_the_same_samples_and_another_seed_others) {
  const auto first = sample_workspace(neuro(), neuro_range, 500, 42);
  const auto again = sample_workspace(neuro(), neuro_range, 500, 42);
  const auto other = sample_workspace(neuro(), neuro_range, 500, 43);
  ASSERT_EQ(first->samples.size(), again->samples.size());
  for (std::size_t number = 0; number < first->samples.size(); ++number) {
    EXPECT_EQ(first->samples[number].joints, again->samples[number].joints);
  }
  EXPECT_NE(first->samples.front().joints, other->samples.front().joints);
}

TEST(Workspace, each_draw_is_a_sample_or_counted_as_refused) {
  const auto neuro_space = sample_workspace(neuro(), neuro_range, 5000, 1);
  EXPECT_EQ(neuro_space->samples.size() + neuro_space->refused, 5000U);
  EXPECT_GT(neuro_space->refused, 0U);
  const auto prostate_space = sample_workspace(prostate(), prostate_range, 5000, 1);
  EXPECT_EQ(prostate_space->samples.size() + prostate_space->refused, 5000U);
  EXPECT_FALSE(prostate_space->samples.empty());
}

TEST(Workspace, samples_keep_to_range_and_bounds_and_lead_back_to_their_joints) {
  const auto space = *sample_workspace(neuro(), neuro_range, 2000, 3);
  for (const auto& sample : space.samples) {
    for (const auto& field : neuro_joint_fields) {
      EXPECT_GE(sample.joints.*field.position, neuro_range.lowest.*field.position);
      EXPECT_LE(sample.joints.*field.position, neuro_range.highest.*field.position);
    }
    EXPECT_TRUE(space.bounds.contains(sample.position_mm));
    const auto pose = *neuro().zframe_from_treatment(sample.joints);
    EXPECT_EQ(sample.position_mm, pose.translation());
    EXPECT_EQ(sample.approach, pose.linear().col(2));
  }
}

TEST(Workspace, without_a_reachable_joint_is_empty) {
  const JointRange<NeuroJoints> wide{{.head_mm = 50.0}, {.head_mm = 60.0}};
  const auto space = *sample_workspace(neuro(), wide, 100, 1);
  EXPECT_TRUE(space.samples.empty());
  EXPECT_EQ(space.refused, 100U);
  EXPECT_TRUE(space.bounds.isEmpty());
}

TEST(Workspace, bad_range_or_count_is_refused_by_name) {
  JointRange<NeuroJoints> upside_down = neuro_range;
  std::swap(upside_down.lowest.yaw_rad, upside_down.highest.yaw_rad);
  EXPECT_EQ(sample_workspace(neuro(), upside_down, 10, 1).error().quantity, "yaw_rad");
  JointRange<ProstateJoints> not_finite = prostate_range;
  not_finite.highest.insertion_mm = std::nan("");
  EXPECT_EQ(sample_workspace(prostate(), not_finite, 10, 1).error().quantity, "insertion_mm");
  EXPECT_EQ(sample_workspace(neuro(), neuro_range, largest_sample_count + 1, 1).error().quantity,
            "sample_count");
}

}  // namespace
}  // namespace interlock::test
