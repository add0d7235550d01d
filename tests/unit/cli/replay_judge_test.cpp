#include <gtest/gtest.h>

#include "cli/replay_views.hpp"

extern "C" {
#include "world.h"
}

namespace interlock::cli {
namespace {

/** Ticks of the random world, as a recording gives them. */
class ReplayJudgeTest : public ::testing::Test {
 protected:
  ReplayJudgeTest() {
    world_config(&config_);
    world_begin(&world_, 1);
    ilk_init(&config_, &tick_.picture.state);
  }

  void step() {
    ilk_picture_t& picture = tick_.picture;
    before_ = picture.state;
    world_inputs(&world_, &config_, &picture.state, &picture.out, &picture.inputs);
    tick_.request_count = world_requests(&world_, &config_, &picture.state, tick_.request);
    ilk_step(&config_, &picture.state, &picture.inputs, tick_.request, tick_.request_count, &picture.out);
    tick_.tick = picture.state.system.tick;
  }

  /** Steps, and judges but for the ticks from `gap` on until `end_of_gap`. */
  ReplayJudge judged(std::uint32_t ticks, std::uint32_t gap = 0, std::uint32_t end_of_gap = 0) {
    ReplayJudge judge(config_);
    for (std::uint32_t n = 0; n < ticks; ++n) {
      step();
      if (n < gap || n >= end_of_gap) {
        judge.add(before_, tick_);
      }
    }
    return judge;
  }

  ilk_config_t config_{};
  world_t world_{};
  ilk_state_t before_{};
  ilk_recorded_tick_t tick_{};
};

TEST_F(ReplayJudgeTest, accepts_each_tick_of_a_run_in_which_everything_goes_wrong) {
  const ReplayJudge judge = judged(30'000);
  EXPECT_FALSE(judge.violation()) << describe(*judge.violation());
  EXPECT_EQ(judge.ticks(), 30'000);
}

TEST_F(ReplayJudgeTest, begins_anew_after_each_gap) {
  for (int n = 0; n < 50; ++n) {
    const ReplayJudge judge = judged(300, 100, 200);
    EXPECT_FALSE(judge.violation()) << describe(*judge.violation());
    EXPECT_EQ(judge.ticks(), 200);
  }
}

TEST_F(ReplayJudgeTest, names_property_tick_axis_found_and_bound_of_the_first_violation) {
  ReplayJudge judge = judged(1);
  step();
  tick_.picture.out.command[3] = {ILK_DIRECTION_INCREASING, 70, 0};
  judge.add(before_, tick_);
  ASSERT_TRUE(judge.violation());
  EXPECT_EQ(describe(*judge.violation()),
            "tick 2, axis in slot 3: P1: drive outside of MOTION: found 1, bound 3");
  step();
  judge.add(before_, tick_);
  EXPECT_EQ(judge.violation()->tick, 2);
  EXPECT_EQ(judge.ticks(), 2);
}

TEST_F(ReplayJudgeTest, names_no_axis_where_all_of_the_robot_is_meant) {
  ReplayJudge judge = judged(0);
  step();
  tick_.picture.out.power = 1;
  judge.add(before_, tick_);
  ASSERT_TRUE(judge.violation());
  EXPECT_EQ(describe(*judge.violation()),
            "tick 1: P2: power is on in READY and MOTION only: found 1, bound 0");
}

}  // namespace
}  // namespace interlock::cli
