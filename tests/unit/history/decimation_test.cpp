#include "history/decimation.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "robot_fixture.hpp"

namespace interlock {
namespace {

using test::insertion;
using test::yaw;

constexpr std::uint32_t length = ticks_of_bucket(1000);

/** Ticks of the neuro robot, whose axes are where the test puts them. */
class DecimationTest : public testing::Test {
 protected:
  DecimationTest() : view_(test::ready_view()) {
    view_.snapshot.state.system.tick = 10 * length - 1;
    for (ilk_axis_t& each : view_.snapshot.state.axis) {
      each.card_valid = 1;
    }
  }

  [[nodiscard]] ilk_axis_t& axis(std::uint32_t slot) { return view_.snapshot.state.axis[slot]; }

  /** One further tick. */
  void tick() {
    ++view_.snapshot.state.system.tick;
    for (ilk_axis_t& each : view_.snapshot.state.axis) {
      each.card_time_us += 1000;
    }
    take();
  }

  void take() {
    if (const auto bucket = decimation_.take(generation_, view_.snapshot, view_.force)) {
      complete_.push_back(*bucket);
    }
  }

  /** Ticks up to the first of another bucket; the one before. */
  TickBucket rest_of_bucket() {
    const std::size_t before = complete_.size();
    while (complete_.size() == before) {
      tick();
    }
    return complete_.back();
  }

  Decimation decimation_{RobotPlan(test::neuro(), test::neuro_config())};
  ControlView view_;
  std::uint32_t generation_ = 1;
  std::vector<TickBucket> complete_;
};

TEST_F(DecimationTest, KeepsAPeakOfOneTick) {
  tick();
  axis(insertion).position_counts += 700;
  tick();
  axis(insertion).position_counts -= 700;
  const std::int32_t rest = axis(insertion).position_counts;
  const auto position = rest_of_bucket().axis[insertion].position_counts;
  EXPECT_EQ(position.least(), rest);
  EXPECT_EQ(position.greatest(), rest + 700);
}

TEST_F(DecimationTest, EndsABucketAtEachMultipleOfItsLength) {
  for (std::uint32_t i = 0; i < 3 * length + 1; ++i) {
    tick();
  }
  ASSERT_EQ(complete_.size(), 3u);
  for (const TickBucket& bucket : complete_) {
    EXPECT_EQ(bucket.ticks, length);
    EXPECT_EQ(bucket.last_tick % length, length - 1);
    EXPECT_EQ(bucket.run, 1u);
  }
}

TEST_F(DecimationTest, TellsHowManyTicksWereSeen) {
  tick();
  view_.snapshot.state.system.tick += 5;
  EXPECT_EQ(rest_of_bucket().ticks, length - 5);
}

TEST_F(DecimationTest, HasASetpointAndAnErrorOnlyWhileMoving) {
  tick();
  const auto resting = rest_of_bucket().axis[yaw];
  EXPECT_FALSE(resting.setpoint_counts.known());
  EXPECT_FALSE(resting.error_counts.known());
  axis(yaw).state = ILK_AXIS_MOVING;
  axis(yaw).position_counts = 100;
  axis(yaw).setpoint_counts = 140;
  tick();
  axis(yaw).position_counts = 150;
  tick();
  axis(yaw).state = ILK_AXIS_ENABLED;
  const auto moved = rest_of_bucket().axis[yaw];
  EXPECT_EQ(moved.setpoint_counts.least(), 140);
  EXPECT_EQ(moved.setpoint_counts.greatest(), 140);
  EXPECT_EQ(moved.error_counts.least(), -10);
  EXPECT_EQ(moved.error_counts.greatest(), 40);
}

TEST_F(DecimationTest, AnErrorThatDoesNotFitIsTheLargestThatDoes) {
  axis(yaw).state = ILK_AXIS_MOVING;
  axis(yaw).position_counts = std::numeric_limits<std::int32_t>::min();
  axis(yaw).setpoint_counts = std::numeric_limits<std::int32_t>::max();
  tick();
  EXPECT_EQ(rest_of_bucket().axis[yaw].error_counts.greatest(), std::numeric_limits<std::int32_t>::max());
}

TEST_F(DecimationTest, ShowsNoPositionOfACardThatIsNotHeard) {
  axis(yaw).card_valid = 0;
  tick();
  const TickBucket bucket = rest_of_bucket();
  EXPECT_FALSE(bucket.axis[yaw].position_counts.known());
  EXPECT_FALSE(bucket.axis[yaw].velocity_counts_per_s.known());
  EXPECT_TRUE(bucket.axis[insertion].position_counts.known());
}

TEST_F(DecimationTest, TheDriveHasTheSenseOfItsDirection) {
  view_.snapshot.command[yaw] = {ILK_DIRECTION_DECREASING, 30, 0};
  tick();
  view_.snapshot.command[yaw] = {ILK_DIRECTION_INCREASING, 12, 0};
  const auto drive = rest_of_bucket().axis[yaw].drive;
  EXPECT_EQ(drive.least(), -30);
  EXPECT_EQ(drive.greatest(), 12);
}

TEST_F(DecimationTest, TheVelocityIsThatOfTheCardsClock) {
  for (std::uint32_t i = 0; i < 2 * length; ++i) {
    axis(insertion).position_counts += 2;
    tick();
  }
  const auto& velocity = complete_.back().axis[insertion].velocity_counts_per_s;
  EXPECT_NEAR(velocity.least(), 2000.0F, 1.0F);
  EXPECT_NEAR(velocity.greatest(), 2000.0F, 1.0F);
}

TEST_F(DecimationTest, AnotherKernelBeginsAnotherRun) {
  tick();
  generation_ = 2;
  tick();
  ASSERT_EQ(complete_.size(), 1u);
  EXPECT_EQ(complete_[0].run, 1u);
  EXPECT_EQ(complete_[0].ticks, 1u);
  EXPECT_EQ(rest_of_bucket().run, 2u);
}

TEST_F(DecimationTest, TicksThatBeginAnewBeginAnotherRun) {
  tick();
  view_.snapshot.state.system.tick = 0;
  take();
  ASSERT_EQ(complete_.size(), 1u);
  EXPECT_EQ(rest_of_bucket().run, 2u);
}

TEST_F(DecimationTest, AForceIsOfTheTickInWhichItWasRead) {
  view_.force = test::needle_view(1970, 1780).force;
  view_.force.tick = view_.snapshot.state.system.tick + 1;
  tick();
  view_.force.hand = 4000;
  EXPECT_EQ(rest_of_bucket().hand_counts.greatest(), 1970u) << "the later reading is of no later tick";
  EXPECT_FALSE(rest_of_bucket().needle_counts.known());
}

}  // namespace
}  // namespace interlock
