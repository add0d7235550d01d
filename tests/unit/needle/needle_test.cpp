/** @file Where a needle with a bevelled tip goes. */
#include "needle/needle.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace interlock::needle::test {
namespace {

constexpr double period_s = 0.001;

NeedleParameters exact(double curvature_per_mm) {
  NeedleParameters parameters;
  parameters.curvature_per_mm = curvature_per_mm;
  parameters.lag_s = 0.0;
  return parameters;
}

/** Goes in at 5 mm/s and turns at `spin_rad_s`. */
Needle after_mm(const NeedleParameters& parameters, double way_mm, double spin_rad_s) {
  Needle needle(parameters, Noise(1, 0));
  for (int tick = 0; tick < static_cast<int>(std::lround(way_mm / (5.0 * period_s))); ++tick) {
    needle.advance(5.0, spin_rad_s, period_s);
  }
  return needle;
}

TEST(Needle, bends_along_a_circle_towards_minus_y) {
  for (const double curvature : {0.001, 0.0041, 0.01}) {
    const Needle needle = after_mm(exact(curvature), 100.0, 0.0);
    const double angle = 100.0 * curvature;
    EXPECT_NEAR(needle.tip_mm().x(), 0.0, 1e-9);
    EXPECT_NEAR(needle.tip_mm().y(), -(1 - std::cos(angle)) / curvature, 1e-9);
    EXPECT_NEAR(needle.tip_mm().z(), std::sin(angle) / curvature, 1e-9);
    EXPECT_NEAR(needle.ahead().z(), std::cos(angle), 1e-12);
  }
}

TEST(Needle, bends_where_its_bevel_points) {
  NeedleParameters parameters = exact(0.0041);
  parameters.bevel_rad = 1.5707963267948966;
  const Needle needle = after_mm(parameters, 50.0, 0.0);
  EXPECT_GT(needle.tip_mm().x(), 5.0);
  EXPECT_NEAR(needle.tip_mm().y(), 0.0, 1e-9);
}

TEST(Needle, turns_its_tip_once_its_hub_has_taken_up_play_and_winding) {
  NeedleParameters parameters = exact(0.0041);
  parameters.torsion_play_rad = 0.1;
  parameters.windup_rad_per_mm = 0.008;
  Needle needle(parameters, Noise(1, 0));
  needle.move(50.0, 0.0);
  const Eigen::Vector3d ahead = needle.ahead();
  const auto bends_to_x_by = [&](double turned_rad) {
    Needle turned = needle;
    turned.move(0.0, turned_rad);
    turned.move(10.0, 0.0);
    return turned.ahead().x() - ahead.x();
  };
  EXPECT_NEAR(bends_to_x_by(0.49), 0.0, 1e-12) << "0.1 rad of play and 0.4 of winding at 50 mm";
  EXPECT_GT(bends_to_x_by(1.5), 0.02) << "the tip turned by a radian";
  EXPECT_NEAR(bends_to_x_by(-0.49), 0.0, 1e-12);
}

TEST(Needle, goes_straight_without_curvature_or_at_full_spin) {
  EXPECT_LT((after_mm(exact(0.0), 100.0, 3.0).tip_mm() - Eigen::Vector3d(0, 0, 100)).norm(), 1e-9);
  // A turn in 2.5 mm: the axis of the helix is tilted by 0.0041 * 2.5 / (2 pi).
  EXPECT_LT(after_mm(exact(0.0041), 100.0, 12.566).tip_mm().head<2>().norm(), 0.18);
}

TEST(Needle, starts_where_and_as_it_enters) {
  NeedleParameters parameters = exact(0.0);
  parameters.entry_mm = {1.0, -2.0};
  parameters.tilt_rad = {0.01, 0.0};
  const Needle needle = after_mm(parameters, 100.0, 0.0);
  EXPECT_NEAR(needle.tip_mm().x(), 2.0, 1e-3);
  EXPECT_NEAR(needle.tip_mm().y(), -2.0, 1e-9);
}

TEST(Needle, wanders_by_the_root_of_the_depth) {
  NeedleParameters parameters = exact(0.0);
  parameters.wander_rad = 1e-3;
  double squares = 0.0;
  constexpr int needles = 400;
  for (std::uint64_t seed = 1; seed <= needles; ++seed) {
    Needle needle(parameters, Noise(seed, 0));
    for (int tick = 0; tick < 500; ++tick) {
      needle.advance(50.0, 3.0, period_s);
    }
    squares += needle.ahead().head<2>().squaredNorm() / (2 * needles);
  }
  // 25 mm of tissue: five times the wander of one.
  EXPECT_NEAR(std::sqrt(squares), 5e-3, 4e-4);
}

TEST(Needle, shows_whole_counts_of_the_published_encoders) {
  const Needle needle = after_mm(exact(0.0041), 10.0, 1.0);
  const double insertion_counts = needle.seen_insertion_mm() * 1666.67;
  const double rotation_counts = needle.seen_rotation_rad() * 265.27;
  EXPECT_NEAR(insertion_counts, std::round(insertion_counts), 1e-6);
  EXPECT_NEAR(rotation_counts, std::round(rotation_counts), 1e-6);
  EXPECT_NEAR(needle.seen_insertion_mm(), 10.0, 1.0 / 1666.67 + 1e-9);
  EXPECT_NEAR(needle.seen_rotation_rad(), 2.0, 1.0 / 265.27 + 1e-9);
}

TEST(Needle, coasts_by_its_lag) {
  NeedleParameters parameters = exact(0.0);
  parameters.lag_s = 0.005;
  Needle needle(parameters, Noise(1, 0));
  for (int tick = 0; tick < 1000; ++tick) {
    needle.advance(5.0, 0.0, period_s);
  }
  const double before_mm = needle.insertion_mm();
  for (int tick = 0; tick < 1000; ++tick) {
    needle.advance(0.0, 0.0, period_s);
  }
  EXPECT_NEAR(needle.insertion_mm() - before_mm, 5.0 * 0.005, 1e-9);
}

}  // namespace
}  // namespace interlock::needle::test
