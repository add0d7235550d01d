/** @file How tissue holds a needle back. */
#include "needle/tissue.hpp"

#include <gmock/gmock.h>

namespace interlock::needle::test {
namespace {

constexpr double press_period_s = 0.001;
constexpr double step_mm = 0.004;

/** Two layers, no noise, no viscosity: each force follows from the table in the header. */
TissueParameters exact() {
  TissueParameters tissue;
  tissue.layers = {
      {.thickness_mm = 20.0, .cutting_n = 1.0, .stiffness_n_per_mm = 0.5, .friction_n_per_mm = 0.02},
      {.thickness_mm = 30.0, .cutting_n = 0.4, .stiffness_n_per_mm = 0.2, .friction_n_per_mm = 0.05}};
  tissue.viscosity_n_s_per_mm = 0.0;
  tissue.texture_n = 0.0;
  return tissue;
}

class Insertion {
 public:
  explicit Insertion(const TissueParameters& parameters, std::uint64_t seed = 1)
      : tissue_(parameters, Noise(seed, 0)) {}

  double to(double depth_mm) {
    const double way_mm = depth_mm > depth_mm_ ? step_mm : -step_mm;
    while (std::abs(depth_mm_ - depth_mm) > step_mm) {
      depth_mm_ += way_mm;
      force_n_ = tissue_.press(depth_mm_, press_period_s);
      largest_n_ = std::max(largest_n_, force_n_);
    }
    return force_n_;
  }

  double rest(double time_s) {
    for (double passed_s = 0.0; passed_s < time_s; passed_s += press_period_s) {
      force_n_ = tissue_.press(depth_mm_, press_period_s);
    }
    return force_n_;
  }

  double largest_n() const { return largest_n_; }
  const Tissue& tissue() const { return tissue_; }

 private:
  Tissue tissue_;
  double depth_mm_ = 0.0;
  double force_n_ = 0.0;
  double largest_n_ = 0.0;
};

TEST(Tissue, cuts_at_each_layers_force_and_rubs_more_the_deeper) {
  Insertion insertion(exact());
  EXPECT_NEAR(insertion.to(10.0), 1.0 + 10.0 * 0.02, 0.01);
  EXPECT_NEAR(insertion.to(19.9), 1.0 + 19.9 * 0.02, 0.01);
  EXPECT_NEAR(insertion.to(21.0), 0.8 + 20.0 * 0.02 + 0.05, 0.01);
  EXPECT_NEAR(insertion.to(60.0), 0.4 + 20.0 * 0.02 + 40.0 * 0.05, 0.01);
}

TEST(Tissue, stiffens_by_what_is_cut) {
  Insertion insertion(exact());
  EXPECT_NEAR(insertion.to(1.0), 0.5 + 0.02, 0.01);
}

TEST(Tissue, tears_a_membrane_at_its_force_and_relaxes) {
  TissueParameters parameters = exact();
  parameters.membranes = {
      {.depth_mm = 10.0, .stiffness_n_per_mm = 0.8, .puncture_n = 2.0, .relaxation_s = 0.03}};
  Insertion insertion(parameters);
  const double before_n = insertion.to(12.4);
  EXPECT_NEAR(before_n, 1.0 + 12.4 * 0.02 + 2.4 * 0.8, 0.02);
  EXPECT_TRUE(insertion.tissue().punctures().empty());
  insertion.to(12.55);
  ASSERT_EQ(insertion.tissue().punctures().size(), 1u);
  EXPECT_NEAR(insertion.tissue().punctures()[0].depth_mm, 12.5, 0.005);
  EXPECT_NEAR(insertion.largest_n(), 1.0 + 12.5 * 0.02 + 2.0, 0.02);
  EXPECT_NEAR(insertion.rest(0.3), 1.0 + 12.55 * 0.02, 0.02);
}

TEST(Tissue, tears_each_membrane_once) {
  TissueParameters parameters = exact();
  parameters.membranes = {{.depth_mm = 10.0}, {.depth_mm = 30.0}};
  Insertion insertion(parameters);
  insertion.to(50.0);
  insertion.to(5.0);
  insertion.to(50.0);
  ASSERT_EQ(insertion.tissue().punctures().size(), 2u);
  EXPECT_EQ(insertion.tissue().punctures()[0].membrane, 0u);
  EXPECT_EQ(insertion.tissue().punctures()[1].membrane, 1u);
}

TEST(Tissue, holds_a_needle_that_is_withdrawn_by_friction_alone) {
  Insertion insertion(exact());
  insertion.to(15.0);
  EXPECT_NEAR(insertion.to(10.0), -15.0 * 0.02, 0.01);
  EXPECT_NEAR(insertion.to(14.0), 1.0 + 15.0 * 0.02, 0.01);
}

TEST(Tissue, resists_speed_by_its_viscosity) {
  TissueParameters parameters = exact();
  Insertion slow(parameters);
  parameters.viscosity_n_s_per_mm = 0.03;
  Insertion viscous(parameters);
  EXPECT_NEAR(viscous.to(10.0) - slow.to(10.0), 0.03 * step_mm / press_period_s, 1e-9);
}

TEST(Tissue, has_a_texture_of_its_deviation_that_a_seed_repeats) {
  TissueParameters parameters = exact();
  parameters.texture_n = 0.05;
  Insertion smooth(exact());
  Insertion rough(parameters, 5);
  Insertion same(parameters, 5);
  Insertion other(parameters, 6);
  double squares = 0.0;
  constexpr int samples = 3000;
  for (int sample = 1; sample <= samples; ++sample) {
    const double depth_mm = 0.5 * sample;
    const double force_n = rough.to(depth_mm);
    ASSERT_EQ(force_n, same.to(depth_mm));
    squares += std::pow(force_n - smooth.to(depth_mm), 2) / samples;
  }
  EXPECT_NEAR(std::sqrt(squares), 0.05, 0.005);
  EXPECT_NE(rough.to(1501.0), other.to(1501.0));
}

}  // namespace
}  // namespace interlock::needle::test
