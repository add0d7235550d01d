#include "needle/scene.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "interlock/kernel.h"
#include "plant/plant.hpp"

namespace interlock::needle {
namespace {

constexpr plant::Microseconds tick{1000};
constexpr double counts_per_mm = 1000.0;

plant::SceneParameters parameters() {
  plant::SceneParameters scene;
  scene.insertion = {1, counts_per_mm};
  scene.rotation = {0, 100.0};
  scene.hand = {3, 1, 100.0};
  scene.tip = {3, 2, -100.0};
  scene.entry_mm = 10.0;
  scene.texture_n = 0.0;
  scene.layers = {{}};
  scene.membranes = {{.depth_mm = 20.0}};
  scene.target_mm = {1.0, 2.0, 30.0};
  return scene;
}

/** Takes the insertion from one position to the other at 5 mm/s. */
void insert(Scene& scene, double from_mm, double to_mm) {
  plant::AxisPositions counts{};
  for (double at_mm = from_mm; at_mm <= to_mm; at_mm += 0.005) {
    counts[1] = at_mm * counts_per_mm;
    scene.advance(counts, tick);
  }
}

TEST(Scene, InFrontOfTheSkinNothingPressesOnTheNeedle) {
  Scene scene(parameters(), 1);
  insert(scene, 0.0, 9.9);
  EXPECT_EQ(scene.truth().needle_n, 0.0);
  EXPECT_NEAR(scene.truth().depth_mm, -0.1, 0.01);
  EXPECT_THAT(scene.truth().tip_mm, testing::ElementsAre(0.0, 0.0, 0.0));
}

TEST(Scene, TissueHoldsTheNeedleBackAndTheSensorReadsLess) {
  Scene scene(parameters(), 1);
  insert(scene, 0.0, 20.0);
  const double force_n = scene.truth().needle_n;
  EXPECT_GT(force_n, 0.5);
  ASSERT_EQ(scene.loads().size(), 2u);
  EXPECT_EQ(scene.loads()[1].slot, 3u);
  EXPECT_EQ(scene.loads()[1].input, 2u);
  EXPECT_EQ(scene.loads()[1].counts, -std::lround(100.0 * force_n));
}

TEST(Scene, AMembraneTearsOnceAndItsDepthIsKept) {
  Scene scene(parameters(), 1);
  insert(scene, 0.0, 40.0);
  insert(scene, 20.0, 40.0);
  ASSERT_EQ(scene.truth().punctures_mm.size(), 1u);
  // It tears when it was pushed in by 2 N at 0.8 N/mm.
  EXPECT_NEAR(scene.truth().punctures_mm[0], 22.5, 0.01);
}

TEST(Scene, ANeedleThatDoesNotTurnBendsAlongItsCircleTowardsMinusY) {
  Scene scene(parameters(), 1);
  insert(scene, 0.0, 60.0);
  const double angle = 0.0041 * scene.truth().depth_mm;
  EXPECT_NEAR(scene.truth().tip_mm[1], -(1.0 - std::cos(angle)) / 0.0041, 0.01);
  EXPECT_NEAR(scene.truth().tip_mm[2], std::sin(angle) / 0.0041, 0.01);
}

TEST(Scene, AWithdrawnNeedleBendsNothingUntilItIsAsDeepAgain) {
  Scene scene(parameters(), 1);
  insert(scene, 0.0, 40.0);
  const auto tip_mm = scene.truth().tip_mm;
  insert(scene, 20.0, 40.0);
  EXPECT_THAT(scene.truth().tip_mm, testing::Pointwise(testing::DoubleNear(0.01), tip_mm));
}

TEST(Scene, TheHandPressesOnItsOwnInput) {
  Scene scene(parameters(), 1);
  scene.press_hand(3.0);
  scene.advance({}, tick);
  EXPECT_EQ(scene.loads()[0].input, 1u);
  EXPECT_EQ(scene.loads()[0].counts, 300);
}

TEST(Scene, AnImageArrivesLateWithNoiseAndShowsAShiftedTarget) {
  Scene scene(parameters(), 1);
  insert(scene, 0.0, 4.9);  // 0.98 s
  EXPECT_FALSE(scene.newest_image());
  insert(scene, 4.9, 6.0);
  ASSERT_TRUE(scene.newest_image());
  EXPECT_LT(scene.newest_image()->time_s, 0.01);
  scene.shift_target({5.0, 0.0, 0.0});
  insert(scene, 6.0, 40.0);
  EXPECT_NEAR(scene.newest_image()->target_mm[0], 6.0, 2.5);
  EXPECT_NE(scene.newest_image()->target_mm[0], 6.0);
  EXPECT_NEAR(scene.truth().target_mm[0], 6.0, 1e-12);
}

TEST(Scene, ADraggedTargetAnArtefactAndABreathAreInTheImage) {
  plant::SceneParameters moved = parameters();
  moved.image_deviation_mm = 0.0;
  moved.dragged_share = 0.1;
  moved.image_tip_bias_mm = 2.0;
  moved.image_breathing_mm = 3.0;
  moved.image_breath_s = 1e6;
  Scene scene(moved, 1);
  insert(scene, 10.0, 30.0);
  const plant::NeedleTruth truth = scene.truth();
  EXPECT_NEAR(truth.target_mm[2], 32.0, 0.01) << "a tenth of 20 mm ahead";
  const auto& image = scene.newest_image();
  ASSERT_TRUE(image);
  EXPECT_NEAR(image->tip_mm[0] - truth.tip_mm[0], 2.0, 1e-3);
  moved.image_breath_s = 8.0;
  Scene breathing(moved, 1);
  insert(breathing, 10.0, 30.0);
  ASSERT_TRUE(breathing.newest_image());
  EXPECT_DOUBLE_EQ(breathing.newest_image()->time_s, image->time_s) << "at a quarter of a breath";
  EXPECT_NEAR(breathing.newest_image()->target_mm[1] - image->target_mm[1], 3.0, 0.01);
}

TEST(Scene, TheSameSeedGivesTheSameAndAnotherOneNot) {
  plant::SceneParameters wandering = parameters();
  wandering.wander_rad = 0.001;
  Scene one(wandering, 7);
  Scene same(wandering, 7);
  Scene other(wandering, 8);
  for (Scene* scene : {&one, &same, &other}) {
    insert(*scene, 0.0, 40.0);
  }
  EXPECT_EQ(one.truth().tip_mm, same.truth().tip_mm);
  EXPECT_EQ(one.newest_image()->tip_mm, same.newest_image()->tip_mm);
  EXPECT_NE(one.truth().tip_mm, other.truth().tip_mm);
}

TEST(Scene, WithoutANeedleAPlantRefusesAHand) {
  ilk_config_t robot{};
  robot.common.period_us = 1000;
  plant::Plant plant(robot, plant::Parameters{}, 1);
  EXPECT_FALSE(plant.schedule(plant::command::PressHand{1.0}));
  plant.surround(std::make_unique<Scene>(parameters(), 1));
  EXPECT_TRUE(plant.schedule(plant::command::PressHand{1.0}));
}

}  // namespace
}  // namespace interlock::needle
