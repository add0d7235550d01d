#include "motion/linkage_watch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "closed_loop.hpp"

namespace interlock {
namespace {

using test::ClosedLoop;
using test::neuro;

constexpr std::uint32_t feet = 6;
constexpr std::uint32_t head = 7;
constexpr std::uint32_t both = 1u << feet | 1u << head;

std::int32_t counts(std::uint32_t slot, double mm) { return *neuro().at_slot(slot)->to_counts(mm); }

/** The neuro robot: 143 mm apart at home, from 75 to 146 mm; the feet's slider moves outwards downwards. */
class LinkageWatchTest : public testing::Test {
 protected:
  LinkageWatchTest() {
    for (const std::uint32_t slot : {feet, head}) {
      state_.axis[slot].homed = 1;
      state_.axis[slot].state = ILK_AXIS_ENABLED;
    }
  }

  std::uint32_t stand_at(double head_mm, double feet_mm) {
    state_.axis[head].position_counts = counts(head, head_mm);
    state_.axis[feet].position_counts = counts(feet, feet_mm);
    return watch_.see(state_);
  }
  void drive(std::uint32_t slot, std::uint32_t state = ILK_AXIS_MOVING) { state_.axis[slot].state = state; }

  ilk_state_t state_{};
  LinkageWatch watch_{neuro()};
};

TEST_F(LinkageWatchTest, MotionEndsAtEitherBound) {
  drive(head);
  EXPECT_EQ(stand_at(-40.0, 28.0), 0u) << "75 mm";
  EXPECT_EQ(stand_at(-40.2, 28.0), 0u) << "a following error";
  EXPECT_EQ(stand_at(-40.4, 28.0), both);
  EXPECT_EQ(stand_at(-10.0, -13.0), 0u) << "146 mm";
  EXPECT_EQ(stand_at(-9.6, -13.0), both);
}

TEST_F(LinkageWatchTest, MotionThatBringsThePairBackGoesOnAndTurnsAroundNowhere) {
  EXPECT_EQ(stand_at(-60.0, 30.0), 0u) << "53 mm, at rest";
  drive(head);
  EXPECT_EQ(stand_at(-60.2, 30.0), 0u);
  EXPECT_EQ(stand_at(-50.0, 30.0), 0u);
  EXPECT_EQ(stand_at(-50.4, 30.0), both);
  drive(head, ILK_AXIS_ENABLED);
  EXPECT_EQ(stand_at(-50.4, 30.0), 0u);
  drive(feet);
  EXPECT_EQ(stand_at(-50.4, 29.0), 0u) << "as it was found at rest";
}

TEST_F(LinkageWatchTest, APushOfAHandAtRestEndsNothing) {
  EXPECT_EQ(stand_at(-20.0, -40.0), 0u);
  EXPECT_EQ(stand_at(-20.0, 80.0), 0u);
}

TEST_F(LinkageWatchTest, ASliderThatHomesCountsAsIfItStoodAtItsSwitch) {
  state_.axis[head].homed = 0;
  EXPECT_EQ(stand_at(-50.0, -2.0), 0u);
  drive(head, ILK_AXIS_HOMING);
  EXPECT_EQ(stand_at(-50.0, -3.2), 0u);
  EXPECT_EQ(stand_at(-50.0, -3.5), both) << "146.5 mm once it is there";
}

TEST_F(LinkageWatchTest, NothingIsKnownOfASliderThatIsNotHomed) {
  state_.axis[feet].homed = 0;
  drive(head);
  EXPECT_EQ(stand_at(-60.0, 60.0), 0u);
}

TEST_F(LinkageWatchTest, ARobotWithoutSuchAPairIsLeftAlone) {
  Robot robot = neuro();
  robot.kinematics = nullptr;
  watch_ = LinkageWatch(robot);
  drive(head);
  EXPECT_EQ(stand_at(-60.0, 60.0), 0u);
}

class LinkageOnThePlant : public testing::TestWithParam<std::uint32_t> {
 protected:
  LinkageOnThePlant() : loop_(3, GetParam()) {
    loop_.make_all_ready();
    loop_.pedal(false);
    loop_.request(ILK_REQUEST_DISABLE, feet);
    loop_.pedal(true);
  }

  /** Slowly, while the pedal is released: in MOTION a push locks the robot. */
  void pause_and_push_feet(int cm) {
    loop_.pedal(false);
    for (int i = 0; i < 2 * std::abs(cm); ++i) {
      loop_.happen(plant::command::PushAxis{feet, counts(feet, cm < 0 ? -5.0 : 5.0)});
      loop_.run(200);
    }
    loop_.pedal(true);
  }
  [[nodiscard]] double mm(std::uint32_t slot) const {
    return loop_.state().axis[slot].position_counts / neuro().at_slot(slot)->counts_per_unit;
  }
  [[nodiscard]] double separation_mm() const { return 143.0 + mm(head) - mm(feet); }

  template <typename Reached>
  void run_until(Reached reached) {
    for (std::uint32_t i = 0; i < test::minute_ticks && !reached(); ++i) {
      loop_.tick();
    }
    ASSERT_TRUE(reached());
  }

  ClosedLoop loop_;
};

TEST_P(LinkageOnThePlant, AMoveDoesNotGoOnBeyondTheBoundAfterAHandPushedTheOtherSlider) {
  loop_.give(1, MoveTask{head, counts(head, -60.0)});
  run_until([&] { return mm(head) < -20.0; });
  pause_and_push_feet(3);
  run_until([&] { return !is_open(loop_.move(head).phase); });
  EXPECT_EQ(loop_.move(head).phase, TaskPhase::aborted);
  EXPECT_EQ(loop_.move(head).reason, TaskReason::linkage_strained);
  loop_.run(500);
  EXPECT_GT(separation_mm(), 74.0);
  loop_.give(2, MoveTask{head, counts(head, -30.0)});
  run_until([&] { return !is_open(loop_.move(head).phase); });
  EXPECT_EQ(loop_.move(head).phase, TaskPhase::done) << "back";
}

TEST_P(LinkageOnThePlant, AMoveWithoutRoomEndsAtOnce) {
  loop_.give(1, MoveTask{head, counts(head, -60.0)});
  run_until([&] { return mm(head) < -20.0; });
  pause_and_push_feet(6);
  run_until([&] { return !is_open(loop_.move(head).phase); });
  EXPECT_EQ(loop_.move(head).reason, TaskReason::linkage_strained);
  loop_.run(500);
  EXPECT_GT(mm(head), -21.0);
}

TEST_P(LinkageOnThePlant, HomingDoesNotGoOnAfterAHandPushedTheOtherSliderAway) {
  loop_.give(1, MoveTask{head, counts(head, -40.0)});
  run_until([&] { return !is_open(loop_.move(head).phase); });
  loop_.give(2, HomeTask{0, 0, {head}});
  run_until([&] { return loop_.state().axis[head].state == ILK_AXIS_HOMING; });
  pause_and_push_feet(-1);
  run_until([&] { return !is_open(loop_.home().phase); });
  EXPECT_EQ(loop_.home().reason, TaskReason::linkage_strained);
  loop_.run(500);
  EXPECT_NE(loop_.state().axis[head].state, static_cast<std::uint32_t>(ILK_AXIS_HOMING));
  EXPECT_EQ(loop_.outputs().command[head].drive, 0u);
}

INSTANTIATE_TEST_SUITE_P(Latency, LinkageOnThePlant, testing::Values(1u, 4u));

}  // namespace
}  // namespace interlock
