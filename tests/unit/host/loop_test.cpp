#include "loop.h"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>

#include "fixtures.hpp"
#include "interlock/kernel.h"
#include "interlock/link_reader.h"

namespace {

using interlock::host_test::one_axis_config;

/// The loop around the real core, on a bus whose cards never answer, with one app attached by the test.
class Loop : public ::testing::Test {
 protected:
  static bool transact(void* driver, uint32_t /*tick*/, const ilk_outputs_t* /*out*/, ilk_inputs_t* in) {
    in->transaction_done = 1;
    in->frames_received = 0;
    in->estop_loop_closed = 1;
    in->pedal_nc_closed = 1;
    *static_cast<uint32_t*>(driver) += 1;
    return true;
  }

  void SetUp() override { start({ILK_CLOCK_SIM, 0.0, false, 0}); }
  void TearDown() override { ilk_link_regions_destroy(&attachment_.regions); }

  void start(const ilk_run_terms_t& terms) {
    const ilk_bus_t bus{&transactions_, true, transact};
    ilk_loop_init(&loop_, &config_, &terms, bus, &mailbox_, &stop_);
  }

  void attach(uint32_t generation) {
    ilk_error_t error{};
    ASSERT_TRUE(ilk_link_regions_create(&attachment_.regions, generation, &error)) << error.text;
    attachment_.generation = generation;
    attachment_.open = 1;
    mailbox_.offered = &attachment_;
  }

  [[nodiscard]] ilk_snapshot_t published() const {
    ilk_snapshot_t snapshot{};
    uint32_t lock = 0;
    EXPECT_TRUE(ilk_link_read_snapshot(attachment_.regions.kernel, &snapshot, &lock));
    return snapshot;
  }

  ilk_config_t config_ = one_axis_config();
  ilk_link_mailbox_t mailbox_{};
  ilk_attachment_t attachment_{};
  uint32_t transactions_ = 0;
  volatile sig_atomic_t stop_ = 0;
  ilk_loop_t loop_{};
};

TEST_F(Loop, TickIsOneTransactionOneStepOneSnapshot) {
  attach(1);
  for (uint32_t n = 1; n <= 5; ++n) {
    ilk_loop_tick(&loop_);
    EXPECT_EQ(transactions_, n);
    const ilk_snapshot_t snapshot = published();
    EXPECT_EQ(snapshot.state.tick, n);
    EXPECT_EQ(std::memcmp(&snapshot.state, &loop_.shown.state, sizeof snapshot.state), 0);
    EXPECT_EQ(std::memcmp(&snapshot.inputs, &loop_.shown.inputs, sizeof snapshot.inputs), 0);
    EXPECT_EQ(attachment_.regions.kernel->snapshot_lock, 2 * n);
  }
}

TEST_F(Loop, RunsAndCountsTimeWithoutAnyApp) {
  for (uint32_t n = 0; n < 100; ++n) {
    ilk_loop_tick(&loop_);
  }
  EXPECT_EQ(loop_.shown.state.tick, 100u);
  uint64_t steps = 0;
  for (const uint32_t count : loop_.shown.timing.bucket[ILK_PHASE_STEP]) {
    steps += count;
  }
  EXPECT_EQ(steps, 100u);
}

TEST_F(Loop, SnapshotNamesClockBusPeriodAndConfiguration) {
  start({ILK_CLOCK_SIM, 0.0, true, 5});
  attach(1);
  ilk_loop_tick(&loop_);
  const ilk_snapshot_t snapshot = published();
  EXPECT_EQ(snapshot.clock, uint32_t{ILK_CLOCK_SIM});
  EXPECT_EQ(snapshot.simulated, 1u);
  EXPECT_EQ(snapshot.degraded, 1u);
  EXPECT_EQ(snapshot.granted, 5u);
  EXPECT_EQ(snapshot.period_us, 1000u);
  EXPECT_EQ(snapshot.config_crc, config_.crc);
}

TEST_F(Loop, RequestOfTheRingIsJudgedOnceInItsGeneration) {
  attach(7);
  ilk_loop_tick(&loop_);
  EXPECT_EQ(loop_.shown.inputs.link_generation, 7u);
  auto* app = const_cast<ilk_link_app_region_t*>(attachment_.regions.app);
  ilk_link_app_region_t written{};
  ilk_request_t request{};
  request.sequence = 1;
  request.kind = ILK_REQUEST_HEARTBEAT;
  request.holder = 3;
  request.crc = ilk_request_crc(&request);
  ASSERT_TRUE(ilk_link_put_request(attachment_.regions.kernel, &written, &request));
  attachment_.regions.app = &written;
  for (int n = 0; n < 3; ++n) {
    ilk_loop_tick(&loop_);
  }
  attachment_.regions.app = app;
  EXPECT_EQ(attachment_.regions.kernel->request_tail, 1u);
  EXPECT_EQ(loop_.shown.state.requests_accepted, 1u);
  EXPECT_EQ(loop_.shown.state.holder, 3u);
}

TEST_F(Loop, NothingIsReadFromAnAppThatHasGone) {
  attach(1);
  ilk_loop_tick(&loop_);
  attachment_.open = 0;
  ilk_loop_tick(&loop_);
  EXPECT_EQ(loop_.attachment, nullptr);
  EXPECT_EQ(mailbox_.retired, &attachment_);
  EXPECT_EQ(published().state.tick, 1u);
  EXPECT_EQ(loop_.shown.state.tick, 2u);
}

TEST_F(Loop, StopEndsItWithoutAnotherTick) {
  stop_ = 1;
  ilk_loop_tick(&loop_);
  ilk_loop_run(&loop_);
  EXPECT_EQ(transactions_, 0u);
}

TEST_F(Loop, DeadlineCountsAsMissedOnlyBeyondAPeriodAndForTheExecutiveAlone) {
  start({ILK_CLOCK_REAL, 1.0, false, 0xF});
  EXPECT_FALSE(ilk_loop_is_missed(&loop_, 1'000'000));
  EXPECT_TRUE(ilk_loop_is_missed(&loop_, 1'000'001));
  loop_.bus_ns = 20'000'000;
  EXPECT_FALSE(ilk_loop_is_missed(&loop_, 21'000'000));
  EXPECT_TRUE(ilk_loop_is_missed(&loop_, 21'000'001));
  loop_.bus.simulated = false;
  EXPECT_TRUE(ilk_loop_is_missed(&loop_, 1'000'001));
}

TEST_F(Loop, DegradedRunLatchesNoMissedDeadline) {
  start({ILK_CLOCK_REAL, 1.0, true, 0});
  EXPECT_FALSE(ilk_loop_is_missed(&loop_, UINT64_MAX));
}

}  // namespace
