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
  void wait(uint32_t tick, uint32_t patience_ms) {
    ilk_pacing_wait(&pacing, &attachment, tick, patience_ms, &stop);
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
  ilk_pacing_wait(&pacing, nullptr, 1000, kLongPatience, &stop);
  Attached closed;
  closed.attachment.open = 0;
  closed.wait(1000, kLongPatience);
  EXPECT_FALSE(closed.pacing.gave_up);
}

TEST(Pacing, AppThatCatchesUpReleasesTheKernel) {
  Attached attached;
  std::thread app([&] { ilk_link_set_seen_tick(&attached.app, 1000); });
  attached.wait(1000, kLongPatience);
  app.join();
  EXPECT_FALSE(attached.pacing.gave_up);
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

TEST(Pacing, AppThatStandsStillIsGivenUpUntilItMoves) {
  Attached attached;
  attached.wait(1000, kNoPatience);
  EXPECT_TRUE(attached.pacing.gave_up);
  attached.wait(1001, kLongPatience);
  attached.app.seen_tick = 1001;
  attached.wait(1002, kLongPatience);
  EXPECT_FALSE(attached.pacing.gave_up);
}

}  // namespace
