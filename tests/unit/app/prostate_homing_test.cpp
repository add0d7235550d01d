#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "closed_loop.hpp"
#include "plant/parameters_file.hpp"
#include "robot/robot_file.hpp"
#include "unhomed_bounds.hpp"

namespace interlock {
namespace {

using test::ClosedLoop;
using test::prostate;

constexpr double most_separation_mm = 308.0;
constexpr std::uint32_t most_ticks = 600000;

/** Where the sliders stand at power-on, in mm. */
struct Start {
  const char* name = "";
  double left_mm = 0;
  double right_mm = 0;
};

constexpr Start parked{"parked", 150.0, -150.0};

class ProstateRobot : public testing::Test {
 protected:
  static std::unique_ptr<ClosedLoop> robot_at(const Start& start) {
    const ilk_config_t config = test::config_of(prostate());
    auto plant = plant::load_parameters(INTERLOCK_ROBOTS "/../plant/prostate.toml", config);
    if (!plant) {
      throw std::runtime_error(plant.error());
    }
    for (const char* name : {"back_left", "front_left"}) {
      plant->axis[slot(name)].start_counts = start.left_mm * prostate().find(name)->counts_per_unit;
    }
    for (const char* name : {"back_right", "front_right"}) {
      plant->axis[slot(name)].start_counts = start.right_mm * prostate().find(name)->counts_per_unit;
    }
    auto loop = std::make_unique<ClosedLoop>(73, 2u, prostate(), *plant);
    loop->enable_all();
    return loop;
  }

  static std::uint32_t slot(const char* name) { return prostate().find(name)->slot; }

  /** How far the pairs part: the farther of the two. */
  static double separation_mm(const ClosedLoop& loop) {
    return std::max(separation_mm(loop, "back_left", "back_right"),
                    separation_mm(loop, "front_left", "front_right"));
  }

  static double separation_mm(const ClosedLoop& loop, const char* left, const char* right) {
    return loop.true_position(slot(left)) / prostate().find(left)->counts_per_unit -
           loop.true_position(slot(right)) / prostate().find(right)->counts_per_unit;
  }

  /** Homes the robot, pressing the pedal anew as often as it is asked for. */
  static void home(ClosedLoop& loop, std::uint32_t proposal) {
    const auto steps = static_cast<std::uint32_t>(prostate().home_steps.size());
    loop.give(proposal, HomeTask{0, steps, {}});
    loop.pedal(true);
    for (std::uint32_t i = 0; i < most_ticks && is_open(loop.home().phase); ++i) {
      loop.tick();
      if (loop.home().reason == TaskReason::press_again) {
        loop.pedal(false);
        loop.pedal(true);
      }
    }
    loop.pedal(false);
  }

  static void expect_homed_and_parked(const ClosedLoop& loop) {
    ASSERT_EQ(loop.home().phase, TaskPhase::done)
        << "step " << loop.home().step << ", slot " << loop.home().slot << ", reason "
        << static_cast<int>(loop.home().reason) << ", code " << loop.home().code;
    for (const char* name : {"back_left", "front_left", "back_right", "front_right"}) {
      EXPECT_EQ(loop.state().axis[slot(name)].homed, 1u) << name;
      EXPECT_NEAR(std::abs(loop.true_position(slot(name))), 375000, 60) << name;
    }
    EXPECT_EQ(loop.refusals(), 0u);
  }
};

class ProstateHoming : public ProstateRobot, public testing::WithParamInterface<Start> {};

TEST_P(ProstateHoming, NeitherPairPartsTooFarAndNoSliderLeavesItsUnhomedBounds) {
  const auto loop = robot_at(GetParam());
  test::UnhomedBounds bounds(*loop, prostate());
  double widest_mm = 0;
  loop->watch([&] {
    bounds.check();
    widest_mm = std::max(widest_mm, separation_mm(*loop));
  });
  home(*loop, 1);
  EXPECT_LE(widest_mm, most_separation_mm);
  expect_homed_and_parked(*loop);
}

TEST_F(ProstateRobot, MayBeHomedAgainWhenItIsHomed) {
  const auto loop = robot_at(parked);
  home(*loop, 1);
  expect_homed_and_parked(*loop);
  double widest_mm = 0;
  loop->watch([&] { widest_mm = std::max(widest_mm, separation_mm(*loop)); });
  home(*loop, 2);
  EXPECT_LE(widest_mm, most_separation_mm);
  expect_homed_and_parked(*loop);
}

TEST_F(ProstateRobot, KeepsASideTogetherWhenOnlyOneOfItsSlidersIsHomed) {
  const auto loop = robot_at(parked);
  home(*loop, 1);
  expect_homed_and_parked(*loop);
  const std::uint32_t front = slot("front_right");
  const std::uint32_t back = slot("back_right");
  loop->request(ILK_REQUEST_RESTORE, front, loop->state().axis[front].position_counts);
  ASSERT_EQ(loop->state().axis[front].homed, 0u);
  double most_skew_counts = 0;
  loop->watch([&] {
    const double skew = loop->true_position(front) - loop->true_position(back);
    most_skew_counts = std::max(most_skew_counts, std::abs(skew));
  });
  home(*loop, 2);
  EXPECT_LE(most_skew_counts / prostate().find("front_right")->counts_per_unit, 5.0);
  expect_homed_and_parked(*loop);
}

INSTANTIATE_TEST_SUITE_P(Starts, ProstateHoming,
                         testing::Values(parked, Start{"right_at_its_outer_end", 119.0, -185.0},
                                         Start{"left_at_its_outer_end", 185.0, -120.0}),
                         [](const auto& each) { return each.param.name; });

}  // namespace
}  // namespace interlock
