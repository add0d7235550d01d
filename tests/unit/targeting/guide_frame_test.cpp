#include "targeting/guide_frame.hpp"

#include <gtest/gtest.h>

#include <random>

#include "robots.hpp"

namespace interlock {
namespace {

using test::kinematics_of;
using test::place_of;
using test::prostate;

/** Sliders somewhere about their home, so that the needle points and stands differently each time. */
AxisPositions random_sliders(std::mt19937_64& random) {
  std::uniform_real_distribution<double> offset_mm(-5.0, 5.0);
  AxisPositions positions(prostate().axes.size(), 0.0);
  for (const char* slider : {"front_left", "back_left"}) {
    positions[place_of(prostate(), slider)] = 140.0 + offset_mm(random);
  }
  for (const char* slider : {"front_right", "back_right"}) {
    positions[place_of(prostate(), slider)] = -140.0 + offset_mm(random);
  }
  return positions;
}

TEST(GuideFrame, ADepthAheadIsWhereTheInsertionPutsTheTip) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    AxisPositions positions = random_sliders(random);
    const auto guide = zframe_from_guide(prostate(), kinematics_of(prostate()), positions);
    ASSERT_TRUE(guide) << guide.error().message();
    for (const double depth_mm : {0.0, 37.5, 120.0}) {
      positions[place_of(prostate(), "insertion")] = prostate().biopsy->entry_mm + depth_mm;
      const auto tip = kinematics_of(prostate()).zframe_from_treatment(positions);
      ASSERT_TRUE(tip);
      const Eigen::Vector3d expected(0.0, 0.0, depth_mm);
      EXPECT_LT((guide->inverse() * tip->translation() - expected).norm(), 1e-9);
    }
  }
}

/** Steering turns the bevel about z by the position of the rotation axis. */
TEST(GuideFrame, TheNeedleIsTurnedInItByThePositionOfItsRotation) {
  std::mt19937_64 random(2);
  for (const double turned_rad : {-2.0, 0.0, 0.7, 5.5}) {
    AxisPositions positions = random_sliders(random);
    positions[place_of(prostate(), "rotation")] = turned_rad;
    const auto guide = zframe_from_guide(prostate(), kinematics_of(prostate()), positions);
    const auto needle = kinematics_of(prostate()).zframe_from_treatment(positions);
    ASSERT_TRUE(guide && needle);
    const Eigen::Matrix3d turn = (guide->inverse() * *needle).linear();
    const Eigen::Matrix3d expected(Eigen::AngleAxisd(turned_rad, Eigen::Vector3d::UnitZ()));
    EXPECT_LT((turn - expected).norm(), 1e-9) << turned_rad;
  }
}

TEST(GuideFrame, SlidersThatCannotBeHaveNone) {
  AxisPositions positions(prostate().axes.size(), 0.0);
  positions[place_of(prostate(), "front_left")] = 400.0;
  EXPECT_FALSE(zframe_from_guide(prostate(), kinematics_of(prostate()), positions));
}

}  // namespace
}  // namespace interlock
