#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>

#include "interlock/kernel.h"
#include "kinematics/prostate_trapezoids/prostate_kinematics.hpp"
#include "neuro.hpp"
#include "robot/compile.hpp"

namespace interlock {
namespace {

using testing::ElementsAre;

const Robot& prostate() {
  static const Robot robot = load_robot(INTERLOCK_ROBOTS "/prostate.toml").value();
  return robot;
}

const ProstateTrapezoids& geometry() {
  return dynamic_cast<const ProstateKinematics&>(*prostate().kinematics).geometry();
}

TEST(Prostate, the_kernel_accepts_it) {
  const auto config = compile(prostate());
  ASSERT_TRUE(config) << config.error().message();
  EXPECT_EQ(ilk_config_validate(&*config).error, static_cast<std::uint32_t>(ILK_CONFIG_ERROR_NONE));
}

TEST(Prostate, has_the_published_axes_in_their_slots) {
  std::vector<std::pair<std::uint32_t, std::string>> axes;
  for (const Axis& axis : prostate().axes) {
    axes.emplace_back(axis.slot, axis.name);
    EXPECT_EQ(axis.role, axis.name);
  }
  using At = std::pair<std::uint32_t, std::string>;
  EXPECT_THAT(axes, ElementsAre(At{0, "rotation"}, At{1, "insertion"}, At{2, "back_left"},
                                At{4, "front_left"}, At{5, "back_right"}, At{6, "front_right"}));
}

TEST(Prostate, has_the_published_geometry_of_2024) {
  EXPECT_EQ(
      geometry(),
      (ProstateTrapezoids{
          124.0, 84.0, 12.0, 67.5, 181.5, 224.0, 15.0, 0.0, 223.4, {0.0, 167.4, 239.71}, 308.0, 0.174533}));
  EXPECT_EQ(prostate().family, "prostate_trapezoids");
}

TEST(Prostate, rotation_is_driven_between_the_published_velocities) {
  const Axis& rotation = *prostate().find("rotation");
  EXPECT_EQ(rotation.card, ILK_CARD_HIGH_FREQUENCY);
  EXPECT_EQ(rotation.drive, (DriveBounds{141386, 3222, 0, 14138, 240}));
  EXPECT_EQ(rotation.gains, (Gains{15.0, 0.3, 4.0}));
}

TEST(Prostate, sliders_keep_their_published_ranges_and_park_at_150_mm) {
  EXPECT_EQ(prostate().find("back_left")->soft_limits, (SoftLimits{100000, 468475}));
  EXPECT_EQ(prostate().find("front_right")->soft_limits, (SoftLimits{-472225, -100000}));
  EXPECT_EQ(prostate().find_home_step("right_park")->move,
            (std::vector<AxisCounts>{{5, -375000}, {6, -375000}}));
  EXPECT_EQ(prostate().find_home_step("left_park")->move,
            (std::vector<AxisCounts>{{2, 375000}, {4, 375000}}));
  EXPECT_EQ(prostate().find("front_left")->to_unit(375000), 150.0);
}

/** The published separation that the linkage must not exceed, whatever its sliders do within one step. */
TEST(Prostate, no_step_of_homing_lets_the_sliders_part_farther_than_the_linkage_allows) {
  const double most_mm = geometry().max_separation_mm;
  for (const std::string end : {"back", "front"}) {
    const Axis& left = *prostate().find(end + "_left");
    const Axis& right = *prostate().find(end + "_right");
    const auto inward_mm = [&right](const char* step) {
      const auto& nudge = prostate().find_home_step(step)->nudge;
      const auto found = std::ranges::find(nudge, right.slot, &AxisCounts::slot);
      return right.to_unit(found->counts);
    };
    const auto target_mm = [](const char* step, const Axis& axis) {
      const auto& move = prostate().find_home_step(step)->move;
      return axis.to_unit(std::ranges::find(move, axis.slot, &AxisCounts::slot)->counts);
    };
    const double left_switch_mm = left.to_unit(left.home_offset_counts + left.mechanics.coast_counts);
    const double right_switch_mm = right.to_unit(right.home_offset_counts - right.mechanics.coast_counts);
    const double right_out_mm = right.to_unit(right.soft_limits.min_counts);
    const double left_in_mm = target_mm("left_inward", left);
    const double right_park_mm = target_mm("right_park", right);
    const double left_park_mm = target_mm("left_park", left);
    EXPECT_LE(left_switch_mm - (right_out_mm + inward_mm("right_inward")), most_mm) << end << ", left_home";
    EXPECT_LE(left_in_mm - right_switch_mm, most_mm) << end << ", right_home and right_park";
    EXPECT_LE(left_park_mm - right_park_mm, most_mm) << end << ", left_park";
  }
}

TEST(Prostate, force_sensor_reads_zero_at_its_references) {
  const Sensor& force = *prostate().find_sensor("force");
  EXPECT_EQ(prostate().sensor_at_slot(3), &force);
  EXPECT_EQ(prostate().at_slot(3), nullptr);
  ASSERT_EQ(force.channels.size(), 2u);
  const SensorChannel& needle = force.channels.at(1);
  EXPECT_EQ(needle.adc, 3u);
  EXPECT_EQ(needle.value(1780), 0.0);
  EXPECT_NEAR(needle.value(1880), -90.24779072786, 1e-9);
  EXPECT_NEAR(force.channels.at(0).value(2070), 90.24779072786, 1e-9);
}

TEST(Prostate, sensor_card_compiles_to_a_bare_slot) {
  const ilk_axis_config_t slot = compile(prostate()).value().axis[3];
  ilk_axis_config_t bare{};
  bare.card = ILK_CARD_SENSOR;
  EXPECT_EQ(std::memcmp(&slot, &bare, sizeof slot), 0);
}

TEST(Prostate, required_sensor_is_required_of_the_kernel) {
  Robot robot = prostate();
  robot.sensors.front().required = true;
  EXPECT_EQ(compile(robot).value().axis[3].required, 1u);
}

}  // namespace
}  // namespace interlock
