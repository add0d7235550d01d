#include "loop.h"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>

#include "fixtures.hpp"
#include "interlock/kernel.h"
#include "interlock/link_reader.h"
#include "interlock/recorded_block.h"

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
  void TearDown() override { ilk_link_regions_destroy(&attachment.regions); }

  void start(const ilk_run_terms_t& terms) {
    const ilk_bus_t bus{&transactions, true, transact};
    ilk_loop_init(&loop, &config, &terms, bus, &mailbox, &stop);
  }

  void attach(uint32_t generation) {
    ilk_error_t error{};
    ASSERT_TRUE(ilk_link_regions_create(&attachment.regions, generation, &error)) << error.text;
    ASSERT_TRUE(ilk_link_regions_settle(&attachment.regions));
    attachment.generation = generation;
    attachment.open = 1;
    mailbox.offered = &attachment;
  }

  [[nodiscard]] ilk_snapshot_t published() const {
    ilk_snapshot_t snapshot{};
    uint32_t lock = 0;
    EXPECT_TRUE(ilk_link_read_snapshot(attachment.regions.kernel, &snapshot, &lock));
    return snapshot;
  }

  ilk_config_t config = one_axis_config();
  ilk_link_mailbox_t mailbox{};
  ilk_attachment_t attachment{};
  uint32_t transactions = 0;
  volatile sig_atomic_t stop = 0;
  ilk_loop_t loop{};
};

TEST_F(Loop, TickIsOneTransactionOneStepOneSnapshot) {
  attach(1);
  for (uint32_t n = 1; n <= 5; ++n) {
    ilk_loop_tick(&loop);
    EXPECT_EQ(transactions, n);
    const ilk_snapshot_t snapshot = published();
    EXPECT_EQ(snapshot.state.system.tick, n);
    EXPECT_EQ(std::memcmp(&snapshot.state, &loop.shown.state, sizeof snapshot.state), 0);
    EXPECT_EQ(std::memcmp(&snapshot.inputs, &loop.shown.inputs, sizeof snapshot.inputs), 0);
    EXPECT_EQ(attachment.regions.kernel->snapshot_lock, 2 * n);
  }
}

TEST_F(Loop, BlackBoxGetsEachTickWithItsRequests) {
  auto box = std::make_unique<ilk_black_box_t>();
  const ilk_black_box_terms_t terms{&config, ILK_CLOCK_SIM, true, 1};
  ilk_error_t error{};
  ASSERT_TRUE(ilk_black_box_create(box.get(), &terms, &error)) << error.text;
  ilk_loop_record(&loop, box.get());
  attach(1);
  ilk_request_t request{};
  request.sequence = 1;
  request.kind = ILK_REQUEST_HEARTBEAT;
  request.crc = ilk_request_crc(&request);
  ilk_loop_tick(&loop);
  auto* app = const_cast<ilk_link_app_region_t*>(attachment.regions.app);
  ilk_link_app_region_t written{};
  ASSERT_TRUE(ilk_link_put_request(attachment.regions.kernel, &written, &request));
  attachment.regions.app = &written;
  ilk_loop_tick(&loop);
  attachment.regions.app = app;
  ilk_block_cursor_t cursor{};
  auto tick = std::make_unique<ilk_recorded_tick_t>();
  ASSERT_TRUE(ilk_block_begin(&cursor, &config, box->block->payload, box->block->header.used, tick.get()));
  ASSERT_EQ(ilk_block_next(&cursor, tick.get()), ILK_TICK_READ);
  EXPECT_EQ(tick->request_count, 0u);
  ASSERT_EQ(ilk_block_next(&cursor, tick.get()), ILK_TICK_READ);
  ASSERT_EQ(tick->request_count, 1u);
  EXPECT_EQ(std::memcmp(&tick->request[0], &request, sizeof request), 0);
  EXPECT_EQ(std::memcmp(&tick->picture.state, &loop.shown.state, sizeof loop.shown.state), 0);
  EXPECT_EQ(std::memcmp(&tick->picture.out, &loop.out, sizeof loop.out), 0);
  EXPECT_EQ(ilk_block_next(&cursor, tick.get()), ILK_TICK_NONE);
  ilk_black_box_close(box.get());
}

TEST_F(Loop, RunsAndCountsTimeWithoutAnyApp) {
  for (uint32_t n = 0; n < 100; ++n) {
    ilk_loop_tick(&loop);
  }
  EXPECT_EQ(loop.shown.state.system.tick, 100u);
  uint64_t steps = 0;
  for (const uint32_t count : loop.shown.timing.bucket[ILK_PHASE_STEP]) {
    steps += count;
  }
  EXPECT_EQ(steps, 100u);
}

TEST_F(Loop, SnapshotNamesClockBusPeriodAndConfiguration) {
  start({ILK_CLOCK_SIM, 0.0, true, 5});
  attach(1);
  ilk_loop_tick(&loop);
  const ilk_snapshot_t snapshot = published();
  EXPECT_EQ(snapshot.clock, uint32_t{ILK_CLOCK_SIM});
  EXPECT_EQ(snapshot.simulated, 1u);
  EXPECT_EQ(snapshot.degraded, 1u);
  EXPECT_EQ(snapshot.granted, 5u);
  EXPECT_EQ(snapshot.period_us, 1000u);
  EXPECT_EQ(snapshot.config_crc, config.crc);
}

TEST_F(Loop, RequestOfTheRingIsJudgedOnceInItsGeneration) {
  attach(7);
  ilk_loop_tick(&loop);
  EXPECT_EQ(loop.shown.inputs.link_generation, 7u);
  auto* app = const_cast<ilk_link_app_region_t*>(attachment.regions.app);
  ilk_link_app_region_t written{};
  ilk_request_t request{};
  request.sequence = 1;
  request.kind = ILK_REQUEST_HEARTBEAT;
  request.holder = 3;
  request.crc = ilk_request_crc(&request);
  ASSERT_TRUE(ilk_link_put_request(attachment.regions.kernel, &written, &request));
  attachment.regions.app = &written;
  for (int n = 0; n < 3; ++n) {
    ilk_loop_tick(&loop);
  }
  attachment.regions.app = app;
  EXPECT_EQ(attachment.regions.kernel->request_tail, 1u);
  EXPECT_EQ(loop.shown.state.system.requests_accepted, 1u);
  EXPECT_EQ(loop.shown.state.system.holder, 3u);
}

TEST_F(Loop, NothingIsReadFromAnAppThatHasGone) {
  attach(1);
  ilk_loop_tick(&loop);
  attachment.open = 0;
  ilk_loop_tick(&loop);
  EXPECT_EQ(loop.attachment, nullptr);
  EXPECT_EQ(mailbox.retired, &attachment);
  EXPECT_EQ(published().state.system.tick, 1u);
  EXPECT_EQ(loop.shown.state.system.tick, 2u);
}

TEST_F(Loop, OnlySimulatedTimeOnASimulatedBusWaitsForAnAppThatConsumesNothing) {
  struct Row {
    ilk_clock_t clock;
    bool simulated;
    bool waits;
  };
  for (const auto& [clock, simulated, waits] :
       {Row{ILK_CLOCK_REAL, true, false}, Row{ILK_CLOCK_REAL, false, false}, Row{ILK_CLOCK_SIM, false, false},
        Row{ILK_CLOCK_SIM, true, true}}) {
    ilk_link_regions_destroy(&attachment.regions);
    start({clock, 0.0, false, 0});
    loop.bus.simulated = simulated;
    attach(1);
    for (uint32_t n = 0; n < 3 * ILK_LINK_TICKS_AHEAD; ++n) {
      ilk_loop_tick(&loop);
    }
    EXPECT_EQ(published().state.system.tick, 3 * ILK_LINK_TICKS_AHEAD);
    EXPECT_EQ(loop.pacing.gave_up, waits) << clock << simulated;
  }
}

TEST_F(Loop, PaceAndLatenessOfTheHostAreShown) {
  start({ILK_CLOCK_SIM, 2.0, false, 0});
  attach(1);
  loop.ticker.deadline_ns -= 5'000'000'000;
  ilk_loop_tick(&loop);
  const ilk_snapshot_t late = published();
  EXPECT_EQ(late.pace_ns, 500'000u);
  EXPECT_GE(late.lateness.total_ms, 4999u);
  EXPECT_GE(late.lateness.worst_us, 4'999'000u);
  EXPECT_EQ(late.overruns, 0u);
  EXPECT_EQ(late.inputs.deadlines_missed, 0u);
}

TEST_F(Loop, StopEndsItWithoutAnotherTick) {
  stop = 1;
  ilk_loop_tick(&loop);
  ilk_loop_run(&loop);
  EXPECT_EQ(transactions, 0u);
}

TEST_F(Loop, DeadlineCountsAsMissedOnlyBeyondAPeriodAndForTheExecutiveAlone) {
  start({ILK_CLOCK_REAL, 1.0, false, 0xF});
  EXPECT_FALSE(ilk_loop_is_missed(&loop, 1'000'000));
  EXPECT_TRUE(ilk_loop_is_missed(&loop, 1'000'001));
  loop.bus_ns = 20'000'000;
  EXPECT_FALSE(ilk_loop_is_missed(&loop, 21'000'000));
  EXPECT_TRUE(ilk_loop_is_missed(&loop, 21'000'001));
  loop.bus.simulated = false;
  EXPECT_TRUE(ilk_loop_is_missed(&loop, 1'000'001));
}

TEST_F(Loop, MissedPeriodsAreToldToTheKernel) {
  start({ILK_CLOCK_REAL, 1.0, false, 0xF});
  loop.bus.simulated = false;
  ilk_loop_tick(&loop);
  const uint64_t begun_ns = ilk_now_ns();
  while (ilk_now_ns() < begun_ns + 20 * loop.ticker.period_ns) {
  }
  ilk_loop_tick(&loop);
  EXPECT_GE(loop.shown.inputs.deadlines_missed, 18u);
  EXPECT_GE(loop.shown.state.system.overruns_in_row, loop.shown.inputs.deadlines_missed);
}

TEST_F(Loop, EachStartHasANonceOfItsOwn) {
  const uint32_t first = loop.shown.inputs.boot_nonce;
  ilk_loop_tick(&loop);
  EXPECT_EQ(loop.shown.inputs.boot_nonce, first) << "the same for one start";
  start({ILK_CLOCK_SIM, 0.0, false, 0});
  const uint32_t second = loop.shown.inputs.boot_nonce;
  EXPECT_NE(second, first);
  ilk_loop_tick(&loop);
  loop.shown.state.seal ^= 1u;
  ilk_loop_tick(&loop);
  ilk_loop_tick(&loop);
  EXPECT_NE(loop.shown.inputs.boot_nonce, second) << "after damage it began anew";
}

TEST_F(Loop, DegradedRunLatchesNoMissedDeadline) {
  start({ILK_CLOCK_REAL, 1.0, true, 0});
  EXPECT_FALSE(ilk_loop_is_missed(&loop, UINT64_MAX));
}

}  // namespace
