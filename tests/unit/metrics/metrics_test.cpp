#include "metrics/metrics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "robot_fixture.hpp"

namespace interlock {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::Not;

std::string text_of(const ControlView& view, const AppCounts& counts = {}) {
  return metrics_text(test::neuro(), test::neuro_config(), view, counts, view.received + milliseconds(40));
}

TEST(Metrics, OfAKernelAreLeftOutWhileNoneIsAttached) {
  const std::string text = text_of(ControlView{}, {.consoles = 3});
  EXPECT_THAT(text, HasSubstr("\ninterlock_kernel_connected 0\n"));
  EXPECT_THAT(text, HasSubstr("\ninterlock_consoles 3\n"));
  EXPECT_THAT(text, Not(HasSubstr("interlock_mode")));
  EXPECT_THAT(text, Not(HasSubstr("interlock_snapshot_age_seconds")));
}

TEST(Metrics, CountLostLinesAndRefusalsWithoutAKernel) {
  const std::string text = text_of(ControlView{}, {.log_lines_lost = 12, .role_refusals = 5});
  EXPECT_THAT(text, HasSubstr("# TYPE interlock_log_lines_lost_total counter\n"
                              "interlock_log_lines_lost_total 12\n"));
  EXPECT_THAT(text, HasSubstr("# TYPE interlock_role_refusals_total counter\n"
                              "interlock_role_refusals_total 5\n"));
}

TEST(Metrics, TellModeAgeAndLoop) {
  ControlView view = test::ready_view();
  view.snapshot.state.system.tick = 1234;
  view.snapshot.overruns = 2;
  view.snapshot.lateness = {.second_us = 0, .worst_us = 250'000, .total_ms = 1500};
  view.snapshot.period_us = 1000;
  view.snapshot.timing.max_ns[ILK_PHASE_BUS] = 250000;
  const std::string text = text_of(view);
  EXPECT_THAT(text, HasSubstr("\ninterlock_mode{mode=\"READY\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("\ninterlock_mode{mode=\"LOCKED\"} 0\n"));
  EXPECT_THAT(text, HasSubstr("\ninterlock_snapshot_age_seconds 0.04\n"));
  EXPECT_THAT(text, HasSubstr("# TYPE interlock_ticks_total counter\ninterlock_ticks_total 1234\n"));
  EXPECT_THAT(text, HasSubstr("\ninterlock_overruns_total 2\n"));
  EXPECT_THAT(text, HasSubstr("\ninterlock_host_late_seconds_total 1.5\n"));
  EXPECT_THAT(text, HasSubstr("\ninterlock_host_late_worst_seconds 0.25\n"));
  EXPECT_THAT(text, HasSubstr("\ninterlock_period_seconds 0.001\n"));
  EXPECT_THAT(text, HasSubstr("\ninterlock_phase_max_seconds{phase=\"bus\"} 0.00025\n"));
}

TEST(Metrics, CountDurationsUpToTheEndOfEachBucket) {
  ControlView view = test::ready_view();
  view.snapshot.timing.bucket[ILK_PHASE_STEP][0] = 3;
  view.snapshot.timing.bucket[ILK_PHASE_STEP][9] = 5;
  view.snapshot.timing.bucket[ILK_PHASE_STEP][ILK_LINK_BUCKETS - 1] = 1;
  const std::string text = text_of(view);
  EXPECT_THAT(text, HasSubstr("\ninterlock_phase_seconds_bucket{phase=\"step\",le=\"2e-09\"} 3\n"));
  EXPECT_THAT(text, HasSubstr("{phase=\"step\",le=\"5.12e-07\"} 3\n"));
  EXPECT_THAT(text, HasSubstr("{phase=\"step\",le=\"1.024e-06\"} 8\n"));
  EXPECT_THAT(text, HasSubstr("{phase=\"step\",le=\"+Inf\"} 9\n"));
  EXPECT_THAT(text, HasSubstr("{phase=\"bus\",le=\"+Inf\"} 0\n"));
}

TEST(Metrics, NameEachAxisOfTheRobotAndNoEmptySlot) {
  ControlView view = test::ready_view();
  view.snapshot.state.axis[test::pitch].state = ILK_AXIS_FAULTED;
  view.snapshot.state.axis[test::pitch].fault = ILK_FAULT_STALL;
  view.snapshot.state.axis[test::pitch].position_counts = -42;
  view.snapshot.state.axis[test::yaw].checksum_failures = 7;
  view.snapshot.state.axis[test::empty_slot].checksum_failures = 99;
  const std::string text = text_of(view);
  EXPECT_THAT(text, HasSubstr("\ninterlock_axis_state{axis=\"pitch\",state=\"FAULTED\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("\ninterlock_axis_fault{axis=\"pitch\",fault=\"STALL\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("\ninterlock_axis_position_counts{axis=\"pitch\"} -42\n"));
  EXPECT_THAT(text, HasSubstr("\ninterlock_card_checksum_failures_total{axis=\"yaw\"} 7\n"));
  EXPECT_THAT(text, Not(HasSubstr(" 99\n")));
}

}  // namespace
}  // namespace interlock
