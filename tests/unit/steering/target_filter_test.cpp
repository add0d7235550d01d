/** @file Where the target is, from noisy images. */
#include "steering/target_filter.hpp"

#include <gmock/gmock.h>

#include "needle/noise.hpp"
#include "not_numbers.hpp"

namespace interlock::test {
namespace {

using Code = KinematicsError::Code;
using Eigen::Vector3d;

const Vector3d planned(0.0, 0.0, 100.0);

TEST(TargetFilter, believes_the_plan_until_an_image_says_otherwise) {
  TargetFilter target = TargetFilter::create({}, planned, 0.0).value();
  EXPECT_EQ(target.target_mm(), planned);
  const Vector3d shifted = planned + Vector3d(6.0, 0.0, 0.0);
  ASSERT_TRUE(target.see(0.0, shifted));
  // 36 / (36 + 0.25) of the way, as one measurement against a normal prior says.
  EXPECT_NEAR((target.target_mm() - planned).x(), 6.0 * 36.0 / 36.25, 1e-12);
}

TEST(TargetFilter, averages_the_noise_away) {
  double squared = 0.0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    needle::Noise noise(seed, 0);
    const Vector3d shifted = planned + 5.0 * noise.direction();
    TargetFilter target = TargetFilter::create({}, planned, 0.0).value();
    for (int image = 0; image < 16; ++image) {
      ASSERT_TRUE(target.see(2.0 * image, shifted + noise.normal_vector(0.5)));
    }
    squared += (target.target_mm() - shifted).squaredNorm() / 200;
  }
  // Sixteen even images have 0.5 sqrt(3) / 4; the wander that is allowed for costs a little.
  EXPECT_LT(std::sqrt(squared), 0.3);
}

TEST(TargetFilter, follows_a_target_that_shifts_late) {
  TargetFilter target = TargetFilter::create({}, planned, 0.0).value();
  for (int image = 0; image < 10; ++image) {
    ASSERT_TRUE(target.see(2.0 * image, planned));
  }
  const Vector3d shifted = planned + Vector3d(0.0, 3.0, 0.0);
  for (int image = 10; image < 40; ++image) {
    ASSERT_TRUE(target.see(2.0 * image, shifted));
  }
  EXPECT_LT((target.target_mm() - shifted).norm(), 0.1);
}

TEST(TargetFilter, refuses_what_is_too_far_off_to_be_the_target) {
  TargetFilter target = TargetFilter::create({}, planned, 0.0).value();
  EXPECT_EQ(target.see(1.0, planned + Vector3d(0.0, 31.0, 0.0)).error().quantity, "target_shift_mm");
  EXPECT_EQ(target.target_mm(), planned);
  EXPECT_TRUE(target.see(1.0, planned + Vector3d(0.0, 29.0, 0.0)));
  EXPECT_TRUE(target.images_disagree()) << "refused or not, two images contradict the plan";
}

TEST(TargetFilter, answers_nonsense_with_an_error) {
  TargetFilter target = TargetFilter::create({}, planned, 5.0).value();
  for (const double value : not_numbers) {
    EXPECT_EQ(target.see(value, planned).error().code, Code::not_finite);
    EXPECT_EQ(target.see(6.0, {value, 0.0, 100.0}).error().code, Code::not_finite);
    EXPECT_EQ(TargetFilter::create({}, {0.0, value, 0.0}, 0.0).error().code, Code::not_finite);
    EXPECT_EQ(TargetFilter::create({.shift_sd_mm = value}, planned, 0.0).error().code, Code::not_finite);
  }
  EXPECT_EQ(target.see(4.0, planned).error().quantity, "image_time_s");
  EXPECT_EQ(target.target_mm(), planned);
}

}  // namespace
}  // namespace interlock::test
