/** @file The tip's estimate: late images count as images in time do, and the filter is as sure as it may be.
 */
#include "steering/tip_estimator.hpp"

#include <gmock/gmock.h>

#include "needle/needle.hpp"
#include "needle/noise.hpp"
#include "not_numbers.hpp"

namespace interlock::test {
namespace {

using Code = KinematicsError::Code;
using Eigen::Vector3d;

constexpr double period_s = 0.01;

TipEstimator estimator(const TipBelief& belief = {}) { return TipEstimator::create(belief, 0.0).value(); }

double time_of(int tick) { return tick * period_s; }

/** Goes in at 4 mm/s and turns as a needle that is steered does. */
NeedleMotion motion_of(int tick) { return {0.04, 0.06 + 0.055 * std::sin(0.02 * tick)}; }

double distance(const TipEstimator& left, const TipEstimator& right) {
  return (left.now().guide_from_tip.matrix() - right.now().guide_from_tip.matrix()).cwiseAbs().maxCoeff();
}

TEST(TipEstimator, follows_the_model_without_images) {
  TipEstimator tip = estimator();
  Pose expected = Pose::Identity();
  for (int tick = 1; tick <= 2000; ++tick) {
    ASSERT_TRUE(tip.move(time_of(tick), motion_of(tick)));
    expected = moved_tip(expected, motion_of(tick), TipBelief{}.curvature_per_mm).value();
  }
  EXPECT_LT((tip.now().guide_from_tip.matrix() - expected.matrix()).norm(), 1e-9);
}

TEST(TipEstimator, takes_a_late_image_as_one_in_time) {
  TipEstimator in_time = estimator();
  TipEstimator late = estimator();
  needle::Noise noise(7, 0);
  Vector3d image = Vector3d::Zero();
  for (int tick = 1; tick <= 2000; ++tick) {
    ASSERT_TRUE(in_time.move(time_of(tick), motion_of(tick)));
    ASSERT_TRUE(late.move(time_of(tick), motion_of(tick)));
    if (tick % 200 == 100) {
      image = in_time.now().guide_from_tip.translation() + noise.normal_vector(0.5);
      ASSERT_TRUE(in_time.see(time_of(tick), image));
      EXPECT_GT(distance(in_time, late), 1e-3);
    }
    if (tick % 200 == 0) {
      ASSERT_TRUE(late.see(time_of(tick - 100), image));
      EXPECT_LT(distance(in_time, late), 1e-9);
      EXPECT_NEAR(in_time.now().curvature_per_mm, late.now().curvature_per_mm, 1e-15);
    }
  }
}

TEST(TipEstimator, splits_a_motion_at_an_exposure_within_it) {
  TipEstimator coarse = estimator();
  TipEstimator fine = estimator();
  const NeedleMotion motion{3.0, 0.8};
  const NeedleMotion part{0.75, 0.2};
  ASSERT_TRUE(coarse.move(1.0, motion));
  for (int quarter = 1; quarter <= 4; ++quarter) {
    ASSERT_TRUE(fine.move(0.25 * quarter, part));
  }
  const Vector3d image(0.3, -0.2, 0.8);
  ASSERT_TRUE(coarse.see(0.25, image));
  ASSERT_TRUE(fine.see(0.25, image));
  EXPECT_LT(distance(coarse, fine), 1e-9);
}

/** What came out of one insertion by a needle of unknown curvature, entry, tilt and bevel. */
struct Insertion {
  double position_error_mm;
  double curvature_error_sd; /**< in standard deviations that the filter claims */
  double position_error_sd;  /**< root mean square of three */
  int images_refused;
};

Insertion insertion(std::uint64_t seed) {
  needle::Noise noise(seed, 0);
  TipBelief belief;
  belief.direction_drift_rad = 0.0;
  belief.curvature_drift_per_mm = 0.0;
  needle::NeedleParameters parameters;
  parameters.lag_s = 0.0;
  parameters.curvature_per_mm += noise.normal(belief.curvature_sd_per_mm);
  parameters.entry_mm = noise.normal_vector(belief.start_sd_mm).head<2>();
  parameters.tilt_rad = noise.normal_vector(belief.direction_sd_rad).head<2>();
  parameters.bevel_rad = noise.normal(belief.bevel_sd_rad);
  needle::Needle needle(parameters, needle::Noise(1, 0));
  TipEstimator tip = estimator(belief);
  int refused = 0;
  for (int tick = 1; tick <= 2500; ++tick) {
    const NeedleMotion motion = motion_of(tick);
    needle.advance(motion.insertion_mm / period_s, motion.rotation_rad / period_s, period_s);
    EXPECT_TRUE(tip.move(time_of(tick), motion));
    if (tick % 200 == 0) {
      const auto seen = tip.see(time_of(tick), needle.tip_mm() + noise.normal_vector(belief.image_sd_mm));
      refused += seen ? 0 : 1;
    }
  }
  const TipEstimate& now = tip.now();
  const double error_mm = (now.guide_from_tip.translation() - needle.tip_mm()).norm();
  return {error_mm, (now.curvature_per_mm - parameters.curvature_per_mm) / now.curvature_sd_per_mm,
          error_mm / (std::sqrt(3.0) * now.position_sd_mm), refused};
}

TEST(TipEstimator, is_as_sure_as_its_errors_allow) {
  constexpr int insertions = 200;
  double position = 0.0;
  double curvature = 0.0;
  double squared_mm = 0.0;
  int refused = 0;
  for (int seed = 1; seed <= insertions; ++seed) {
    const Insertion one = insertion(static_cast<std::uint64_t>(seed));
    position += one.position_error_sd * one.position_error_sd / insertions;
    curvature += one.curvature_error_sd * one.curvature_error_sd / insertions;
    refused += one.images_refused;
    squared_mm += one.position_error_mm * one.position_error_mm / insertions;
  }
  std::printf("tip estimate: rms %.3f mm; squared errors over claimed: position %.2f, curvature %.2f\n",
              std::sqrt(squared_mm), position, curvature);
  EXPECT_LE(refused, insertions * 12 / 200) << "of 12 good images each; 3 sigma leave 1 of 370";
  // What it claims is of the last image, a second and 4 mm ago.
  EXPECT_GT(position, 0.5);
  EXPECT_LT(position, 1.3);
  EXPECT_GT(curvature, 0.6);
  EXPECT_LT(curvature, 1.4);
}

TEST(TipEstimator, learns_the_curvature_of_a_needle_that_does_not_turn) {
  for (const double factor : {0.8, 1.2}) {
    needle::NeedleParameters parameters;
    parameters.lag_s = 0.0;
    parameters.curvature_per_mm *= factor;
    needle::Needle needle(parameters, needle::Noise(1, 0));
    needle::Noise noise(3, 0);
    TipEstimator tip = estimator();
    for (int tick = 1; tick <= 2500; ++tick) {
      needle.advance(4.0, 0.0, period_s);
      ASSERT_TRUE(tip.move(time_of(tick), {0.04, 0.0}));
      if (tick % 200 == 0) {
        ASSERT_TRUE(tip.see(time_of(tick), needle.tip_mm() + noise.normal_vector(0.5)));
      }
    }
    EXPECT_NEAR(tip.now().curvature_per_mm / parameters.curvature_per_mm, 1.0, 0.11) << factor;
  }
}

TEST(TipEstimator, refuses_images_that_cannot_be_and_stays_as_it_is) {
  TipEstimator tip = estimator();
  for (int tick = 1; tick <= 300; ++tick) {
    ASSERT_TRUE(tip.move(time_of(tick), motion_of(tick)));
  }
  const Vector3d there = tip.now().guide_from_tip.translation();
  ASSERT_TRUE(tip.see(2.0, {0.0, 0.0, 8.0}));
  const Pose before = tip.now().guide_from_tip;
  for (const double value : not_numbers) {
    EXPECT_EQ(tip.see(value, there).error().code, Code::not_finite);
    EXPECT_EQ(tip.see(3.0, {0.0, value, 0.0}).error().code, Code::not_finite);
  }
  EXPECT_EQ(tip.see(1.5, there).error().quantity, "image_time_s");
  EXPECT_EQ(tip.see(3.5, there).error().quantity, "image_time_s");
  EXPECT_EQ(tip.see(2.5, there + Vector3d(20.0, 0.0, 0.0)).error().quantity, "image_surprise_sd");
  EXPECT_LT((tip.now().guide_from_tip.matrix() - before.matrix()).norm(), 1e-12);
}

TEST(TipEstimator, refuses_an_image_that_shows_the_tip_at_another_depth_than_the_encoder) {
  TipEstimator tip = estimator();
  for (int tick = 1; tick <= 300; ++tick) {
    ASSERT_TRUE(tip.move(time_of(tick), motion_of(tick)));
  }
  const Pose before = tip.now().guide_from_tip;
  for (const double ahead_mm : {-2.5, 2.5}) {
    const Vector3d seen = before * Vector3d(0.0, 0.0, ahead_mm);
    EXPECT_EQ(tip.see(time_of(300), seen).error().quantity, "image_ahead_sd");
  }
  EXPECT_LT((tip.now().guide_from_tip.matrix() - before.matrix()).norm(), 1e-12);
  EXPECT_TRUE(tip.see(time_of(300), before * Vector3d(0.0, 0.0, 2.0)));
  EXPECT_LT((tip.now().guide_from_tip.translation() - before.translation()).norm(), 1.1);
}

TEST(TipEstimator, keeps_so_many_motions_and_no_more) {
  TipEstimator tip = estimator();
  Pose expected = Pose::Identity();
  const int ticks = static_cast<int>(TipEstimator::kept_motions) + 100;
  for (int tick = 1; tick <= ticks; ++tick) {
    ASSERT_TRUE(tip.move(time_of(tick), motion_of(tick)));
    expected = moved_tip(expected, motion_of(tick), TipBelief{}.curvature_per_mm).value();
  }
  EXPECT_LT((tip.now().guide_from_tip.matrix() - expected.matrix()).norm(), 1e-8);
  EXPECT_EQ(tip.see(time_of(99), Vector3d::Zero()).error().quantity, "image_time_s");
  EXPECT_TRUE(tip.see(time_of(ticks), expected.translation()));
}

TEST(TipEstimator, keeps_no_motion_while_the_needle_rests) {
  TipEstimator tip = estimator();
  ASSERT_TRUE(tip.move(0.5, {2.0, 0.3}));
  for (int tick = 100; tick < 30'000; ++tick) {
    ASSERT_TRUE(tip.move(time_of(tick), {}));
  }
  EXPECT_TRUE(tip.see(0.25, {0.0, 0.0, 1.0}));
}

TEST(TipEstimator, answers_nonsense_with_an_error) {
  TipEstimator tip = estimator();
  ASSERT_TRUE(tip.move(1.0, {1.0, 0.1}));
  for (const double value : not_numbers) {
    EXPECT_EQ(tip.move(value, {}).error().code, Code::not_finite);
    EXPECT_EQ(tip.move(2.0, {value, 0.0}).error().code, Code::not_finite);
    EXPECT_EQ(tip.move(2.0, {0.0, value}).error().code, Code::not_finite);
    EXPECT_EQ(TipEstimator::create({}, value).error().code, Code::not_finite);
    TipBelief belief;
    belief.image_sd_mm = value;
    EXPECT_EQ(TipEstimator::create(belief, 0.0).error().code, Code::not_finite);
  }
  EXPECT_EQ(tip.move(1.0, {}).error().quantity, "time_s");
  EXPECT_EQ(tip.move(2.0, {-1.0, 0.0}).error().quantity, "insertion_mm");
  EXPECT_TRUE(tip.move(2.0, {1.0, 0.0}));
}

}  // namespace
}  // namespace interlock::test
