#include "pacing.h"

#include <gtest/gtest.h>

#include <thread>

#include "interlock/link_reader.h"

namespace {

constexpr uint32_t kNoPatience = 0;
constexpr uint32_t kLongPatience = 60'000;

struct Attached {
  ilk_link_app_region_t app{};
  ilk_attachment_t attachment{};
  ilk_pacing_t pacing{};
  volatile sig_atomic_t stop = 0;

  Attached() {
    attachment.regions.app = &app;
    attachment.open = 1;
  }
  bool wait(uint32_t tick, uint32_t patience_ms) {
    return ilk_pacing_wait(&pacing, &attachment, tick, patience_ms, &stop);
  }
};

TEST(Pacing, KernelRunsTenTicksAheadAndNoMore) {
  EXPECT_TRUE(ilk_pacing_may_go_on(100, 100));
  EXPECT_TRUE(ilk_pacing_may_go_on(109, 100));
  EXPECT_FALSE(ilk_pacing_may_go_on(110, 100));
  EXPECT_TRUE(ilk_pacing_may_go_on(3, UINT32_MAX - 5));
  EXPECT_FALSE(ilk_pacing_may_go_on(5, UINT32_MAX - 5));
}

TEST(Pacing, AppAheadOfTheKernelDoesNotHoldIt) {
  EXPECT_TRUE(ilk_pacing_may_go_on(100, 101));
  EXPECT_TRUE(ilk_pacing_may_go_on(100, 1'000'000));
}

TEST(Pacing, NobodyIsWaitedForWithoutAnApp) {
  ilk_pacing_t pacing{};
  const volatile sig_atomic_t stop = 0;
  EXPECT_TRUE(ilk_pacing_wait(&pacing, nullptr, 1000, kLongPatience, &stop));
  Attached closed;
  closed.attachment.open = 0;
  EXPECT_TRUE(closed.wait(1000, kLongPatience));
}

TEST(Pacing, AppThatCatchesUpReleasesTheKernel) {
  Attached attached;
  std::thread app([&] { ilk_link_set_seen_tick(&attached.app, 1000); });
  EXPECT_TRUE(attached.wait(1000, kLongPatience));
  app.join();
}

TEST(Pacing, ClosingTheSocketOrStoppingReleasesTheKernel) {
  Attached attached;
  std::thread server([&] { __atomic_store_n(&attached.attachment.open, 0u, __ATOMIC_RELEASE); });
  attached.wait(1000, kLongPatience);
  server.join();
  Attached stopped;
  stopped.stop = 1;
  stopped.wait(1000, kLongPatience);
  EXPECT_FALSE(stopped.pacing.gave_up);
}

TEST(Pacing, AppThatStandsStillIsGivenUpUntilItSeesATickOfTheTimeSince) {
  Attached attached;
  EXPECT_FALSE(attached.wait(1000, kNoPatience));
  EXPECT_FALSE(attached.wait(1001, kLongPatience));
  attached.app.seen_tick = 1000;
  EXPECT_TRUE(attached.wait(1002, kLongPatience));
}

TEST(Pacing, AppThatWritesOldAndAbsurdTicksIsWaitedForOnce) {
  Attached attached;
  EXPECT_FALSE(attached.wait(1'000'000, kNoPatience));
  for (const uint32_t absurd : {1u, 999'999u, 0u, 500'000u}) {
    attached.app.seen_tick = absurd;
    EXPECT_FALSE(attached.wait(1'000'001, kLongPatience)) << absurd;
  }
}

}  // namespace
