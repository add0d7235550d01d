/** @file CURV's law against published numbers and against the turning needle that it describes. */
#include "steering/curv_law.hpp"

#include <gmock/gmock.h>

#include <complex>

#include "not_numbers.hpp"

namespace interlock::test {
namespace {

using ::testing::DoubleNear;
using Code = KinematicsError::Code;

using std::numbers::pi;

CurvLaw law() { return CurvLaw::create({}).value(); }

TEST(PublishedShare, gives_the_published_alphas) {
  constexpr std::array curvatures{.0007, .0010, .0016, .0022, .0024, .0041};
  constexpr std::array alphas{.475, .605, .782, .887, .911, .999};
  for (std::size_t row = 0; row < alphas.size(); ++row) {
    EXPECT_THAT(published_share(curvatures[row], 0.0045)->alpha, DoubleNear(alphas[row], 5e-4));
  }
}

TEST(PublishedShare, goes_straight_at_no_curvature_and_all_out_beyond_reach) {
  EXPECT_EQ(published_share(0.0, 0.0022)->alpha, 0.0);
  EXPECT_TRUE(published_share(0.0021, 0.0022)->reachable);
  EXPECT_FALSE(published_share(0.0022, 0.0022)->reachable);
  EXPECT_EQ(published_share(0.0022, 0.0022)->alpha, 1.0);
}

TEST(CurvLaw, turns_by_the_formula) {
  const double fastest = law().parameters().fastest_rad_s;
  EXPECT_EQ(*law().speed_rad_s(1.0, 2.0, 0.0), fastest);
  EXPECT_EQ(*law().speed_rad_s(2.0, 2.0, 1.0), 0.0);
  EXPECT_NEAR(*law().speed_rad_s(pi / 3, 0.0, 0.7), fastest * (1.0 - 0.7 * std::exp(-0.5)), 1e-12);
}

TEST(CurvLaw, takes_the_short_way_round_the_circle) {
  EXPECT_NEAR(*law().speed_rad_s(0.1, 2 * pi - 0.1, 0.9), *law().speed_rad_s(0.2, 0.0, 0.9), 1e-12);
  EXPECT_NEAR(*law().speed_rad_s(-0.3, 0.0, 0.9), *law().speed_rad_s(0.3, 0.0, 0.9), 1e-12);
}

TEST(CurvLaw, stays_between_standstill_and_the_fastest_and_repeats_each_turn) {
  Generator generator(1);
  const CurvLaw curv = law();
  for (int trial = 0; trial < 10'000; ++trial) {
    const double angle = between(generator, -40.0, 40.0);
    const double desired = between(generator, 0.0, 2 * pi);
    const double alpha = between(generator, 0.0, 1.0);
    const double speed = *curv.speed_rad_s(angle, desired, alpha);
    ASSERT_GE(speed, 0.0);
    ASSERT_LE(speed, curv.parameters().fastest_rad_s);
    ASSERT_NEAR(*curv.speed_rad_s(angle + 6 * pi, desired, alpha), speed, 1e-10);
  }
}

/** Mean of the bevel's direction while a needle turns for some turns, step by step in time. */
double turned_share(const CurvLaw& curv, double alpha) {
  constexpr double step_s = 1e-4;
  std::complex<double> sum;
  double angle = 0.0;
  int steps = 0;
  while (angle < 6 * pi) {
    const double middle = angle + 0.5 * step_s * *curv.speed_rad_s(angle, 1.0, alpha);
    sum += std::polar(1.0, middle - 1.0);
    angle += step_s * *curv.speed_rad_s(middle, 1.0, alpha);
    ++steps;
  }
  return std::abs(sum) / steps;
}

TEST(CurvLaw, averages_as_a_turning_needle_does) {
  const CurvLaw curv = law();
  for (const double alpha : {0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 0.95, 0.98}) {
    EXPECT_NEAR(*curv.curvature_share(alpha), turned_share(curv, alpha), 1e-3) << alpha;
  }
}

TEST(CurvLaw, finds_the_alpha_of_each_share) {
  const CurvLaw curv = law();
  Generator generator(2);
  for (int trial = 0; trial < 10'000; ++trial) {
    const double largest = between(generator, 1e-4, 0.02);
    const double share = between(generator, 0.0, 1.0);
    const auto [alpha, reachable] = *curv.averaged_share(share * largest, largest);
    ASSERT_TRUE(reachable);
    ASSERT_NEAR(*curv.curvature_share(alpha), share, 1e-9);
  }
}

TEST(CurvLaw, bends_more_with_more_alpha) {
  const CurvLaw curv = law();
  for (int step = 1; step <= 1000; ++step) {
    ASSERT_GT(*curv.curvature_share(step / 1000.0), *curv.curvature_share((step - 1) / 1000.0));
  }
  EXPECT_EQ(*curv.curvature_share(0.0), 0.0);
  EXPECT_EQ(*curv.curvature_share(1.0), 1.0);
}

TEST(CurvLaw, flags_a_curvature_beyond_the_needle) {
  const CurvShare share = *law().averaged_share(0.005, 0.004);
  EXPECT_EQ(share.alpha, 1.0);
  EXPECT_FALSE(share.reachable);
}

TEST(CurvLaw, answers_nonsense_with_an_error) {
  for (const double value : not_numbers) {
    EXPECT_EQ(CurvLaw::create({value, 1.0}).error().code, Code::not_finite);
    EXPECT_EQ(CurvLaw::create({1.0, value}).error().code, Code::not_finite);
    EXPECT_EQ(law().speed_rad_s(value, 0.0, 0.5).error().code, Code::not_finite);
    EXPECT_EQ(law().speed_rad_s(0.0, value, 0.5).error().code, Code::not_finite);
    EXPECT_EQ(law().speed_rad_s(0.0, 0.0, value).error().code, Code::not_finite);
    EXPECT_EQ(law().curvature_share(value).error().code, Code::not_finite);
    EXPECT_EQ(law().averaged_share(value, 0.004).error().code, Code::not_finite);
    EXPECT_EQ(law().averaged_share(0.001, value).error().code, Code::not_finite);
    EXPECT_EQ(published_share(value, 0.004).error().code, Code::not_finite);
    EXPECT_EQ(published_share(0.001, value).error().code, Code::not_finite);
  }
  EXPECT_EQ(CurvLaw::create({0.0, 1.0}).error().code, Code::out_of_range);
  EXPECT_EQ(law().speed_rad_s(0.0, 0.0, 1.1).error().quantity, "alpha");
  EXPECT_EQ(law().averaged_share(-0.001, 0.004).error().quantity, "curvature_per_mm");
  EXPECT_EQ(published_share(0.001, 0.0).error().quantity, "largest_curvature_per_mm");
}

}  // namespace
}  // namespace interlock::test
