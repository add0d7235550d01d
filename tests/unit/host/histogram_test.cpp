#include "histogram.h"

#include <gtest/gtest.h>

namespace {

TEST(Histogram, BucketNCountsFrom2ToTheNUpToTheNextPower) {
  ilk_timing_t timing{};
  for (uint32_t n = 1; n < ILK_LINK_BUCKETS; ++n) {
    ilk_timing_add(&timing, ILK_PHASE_BUS, uint64_t{1} << n);
    ilk_timing_add(&timing, ILK_PHASE_BUS, (uint64_t{2} << n) - 1);
  }
  EXPECT_EQ(timing.bucket[ILK_PHASE_BUS][0], 0u);
  for (uint32_t n = 1; n < ILK_LINK_BUCKETS; ++n) {
    EXPECT_EQ(timing.bucket[ILK_PHASE_BUS][n], 2u) << n;
  }
}

TEST(Histogram, ShortestAndLongestTimesStayInTheOuterBuckets) {
  ilk_timing_t timing{};
  ilk_timing_add(&timing, ILK_PHASE_WAKE, 0);
  ilk_timing_add(&timing, ILK_PHASE_WAKE, 1);
  ilk_timing_add(&timing, ILK_PHASE_WAKE, UINT64_MAX);
  EXPECT_EQ(timing.bucket[ILK_PHASE_WAKE][0], 2u);
  EXPECT_EQ(timing.bucket[ILK_PHASE_WAKE][ILK_LINK_BUCKETS - 1], 1u);
  EXPECT_EQ(timing.max_ns[ILK_PHASE_WAKE], UINT32_MAX);
}

TEST(Histogram, CountsSaturate) {
  ilk_timing_t timing{};
  timing.bucket[ILK_PHASE_STEP][9] = UINT32_MAX;
  ilk_timing_add(&timing, ILK_PHASE_STEP, 1000);
  EXPECT_EQ(timing.bucket[ILK_PHASE_STEP][9], UINT32_MAX);
}

TEST(Histogram, PhasesAreKeptApart) {
  ilk_timing_t timing{};
  ilk_timing_add(&timing, ILK_PHASE_STEP, 1000);
  ilk_timing_add(&timing, ILK_PHASE_PUBLISH, 10);
  EXPECT_EQ(timing.max_ns[ILK_PHASE_STEP], 1000u);
  EXPECT_EQ(timing.max_ns[ILK_PHASE_PUBLISH], 10u);
  EXPECT_EQ(timing.max_ns[ILK_PHASE_BUS], 0u);
}

}  // namespace
