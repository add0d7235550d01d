/** @file The hand's force moves the needle, with the pedal, and never past the setpoint. */
#include "steering/cooperative_insertion.hpp"

#include <gmock/gmock.h>

#include "not_numbers.hpp"

namespace interlock::test {
namespace {

using Code = KinematicsError::Code;

TEST(CooperativeSpeed, grows_with_the_force_beyond_the_deadband) {
  const CooperativeParameters law;
  EXPECT_EQ(*cooperative_speed(law, 0.9, true, 50.0), 0.0);
  EXPECT_DOUBLE_EQ(*cooperative_speed(law, 3.0, true, 50.0), 2.0);
  EXPECT_DOUBLE_EQ(*cooperative_speed(law, 30.0, true, 50.0), law.fastest_mm_s);
}

TEST(CooperativeSpeed, is_zero_without_pedal_at_the_setpoint_and_for_a_pulling_hand) {
  EXPECT_EQ(*cooperative_speed({}, 30.0, false, 50.0), 0.0);
  EXPECT_EQ(*cooperative_speed({}, 30.0, true, 0.0), 0.0);
  EXPECT_EQ(*cooperative_speed({}, 30.0, true, -1.0), 0.0);
  EXPECT_EQ(*cooperative_speed({}, -30.0, true, 50.0), 0.0);
}

TEST(CooperativeSpeed, never_pushes_the_needle_past_its_setpoint) {
  Generator generator(1);
  for (int trial = 0; trial < 200; ++trial) {
    double left_mm = between(generator, 0.0, 5.0);
    for (int tick = 0; tick < 2000; ++tick) {
      left_mm -= 0.001 * *cooperative_speed({}, between(generator, -5.0, 50.0), true, left_mm);
      ASSERT_GE(left_mm, 0.0);
    }
  }
}

TEST(CooperativeSpeed, answers_nonsense_with_an_error) {
  for (const double value : not_numbers) {
    EXPECT_EQ(cooperative_speed({}, value, true, 50.0).error().code, Code::not_finite);
    EXPECT_EQ(cooperative_speed({}, 3.0, true, value).error().code, Code::not_finite);
    EXPECT_EQ(cooperative_speed({.deadband_n = value}, 3.0, true, 50.0).error().code, Code::not_finite);
    EXPECT_EQ(cooperative_speed({.gain_mm_s_n = value}, 3.0, true, 50.0).error().code, Code::not_finite);
    EXPECT_EQ(cooperative_speed({.fastest_mm_s = value}, 3.0, true, 50.0).error().code, Code::not_finite);
    EXPECT_EQ(cooperative_speed({.approach_per_s = value}, 3.0, true, 50.0).error().code, Code::not_finite);
  }
  EXPECT_EQ(cooperative_speed({.gain_mm_s_n = -1.0}, 3.0, true, 50.0).error().quantity, "gain_mm_s_n");
}

}  // namespace
}  // namespace interlock::test
