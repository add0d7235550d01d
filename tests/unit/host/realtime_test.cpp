#include "realtime.h"

#include <gtest/gtest.h>
#include <sched.h>

namespace {

constexpr uint32_t kAll = 0xFu;

TEST(RunPermit, HardwareWithoutEveryMeasureAskedForIsRefused) {
  for (uint32_t granted = 0; granted < kAll; ++granted) {
    EXPECT_EQ(ilk_realtime_permit(ILK_CLOCK_REAL, false, kAll, granted), ILK_REFUSE) << granted;
  }
  EXPECT_EQ(ilk_realtime_permit(ILK_CLOCK_REAL, false, kAll, kAll), ILK_RUN);
}

TEST(RunPermit, HardwareInSimulatedTimeIsRefused) {
  EXPECT_EQ(ilk_realtime_permit(ILK_CLOCK_SIM, false, 0, 0), ILK_REFUSE);
  EXPECT_EQ(ilk_realtime_permit(ILK_CLOCK_SIM, false, kAll, kAll), ILK_REFUSE);
}

TEST(RunPermit, SimulatorOnTheWallClockRunsDegradedWithoutTheMeasures) {
  for (uint32_t granted = 0; granted < kAll; ++granted) {
    EXPECT_EQ(ilk_realtime_permit(ILK_CLOCK_REAL, true, kAll, granted), ILK_RUN_DEGRADED) << granted;
  }
  EXPECT_EQ(ilk_realtime_permit(ILK_CLOCK_REAL, true, kAll, kAll), ILK_RUN);
}

TEST(RunPermit, SimulatedClockNeedsNoMeasureAndAsksForNoneButItsCore) {
  EXPECT_EQ(ilk_realtime_permit(ILK_CLOCK_SIM, true, 0, 0), ILK_RUN);
  ilk_realtime_t realtime{};
  ilk_realtime_acquire(&realtime, ILK_CLOCK_SIM, -1, 80);
  EXPECT_EQ(realtime.asked, 0u);
  EXPECT_EQ(realtime.granted, 0u);
  ilk_realtime_acquire(&realtime, ILK_CLOCK_SIM, CPU_SETSIZE - 1, 80);
  EXPECT_EQ(realtime.asked, 1u << ILK_RT_PINNED);
}

TEST(RunPermit, EveryMeasureHasAName) {
  for (uint32_t measure = 0; measure < ILK_RT_COUNT; ++measure) {
    EXPECT_STRNE(ilk_realtime_name(static_cast<ilk_rt_measure_t>(measure)), "unknown measure");
  }
}

}  // namespace
