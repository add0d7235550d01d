#include "recorder/rescue.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "recorded_run.hpp"

namespace interlock::recorder {
namespace {

namespace fs = std::filesystem;
using recorder_test::RecordedRun;
using recorder_test::ScratchFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/** A kernel that died after 900 calm ticks, its ring left in memory. */
class RescueTest : public ::testing::Test {
 protected:
  void SetUp() override { leave_ring(900); }

  void leave_ring(std::uint32_t ticks) {
    RecordedRun run(ring_file_, 1, 4);
    run.calm(ticks);
    run.die();
  }

  Rescue rescue() {
    return {ring_file_, *folder_, "test", [this](const std::string& line) { told_.push_back(line); }};
  }

  /** As a recorder that begins, for as long as its disk takes something. */
  static void save(Rescue& rescue) {
    rescue.look();
    for (int step = 0; step < 100; ++step) {
      rescue.step();
    }
  }

  [[nodiscard]] std::vector<fs::path> recordings() const {
    std::vector<fs::path> found;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_->path())) {
      found.push_back(entry.path());
    }
    std::ranges::sort(found);
    return found;
  }

  void refuse() { fs::rename(folder_->path(), scratch_.file("away")); }
  void take() { fs::rename(scratch_.file("away"), folder_->path()); }

  ScratchFolder scratch_;
  fs::path ring_file_ = scratch_.file("ring");
  fs::path before_ = scratch_.file(std::string("ring") + ILK_RING_BEFORE);
  Recorded<RecordingFolder> folder_ = RecordingFolder::open(scratch_.file("recordings"), 1ULL << 30);
  std::vector<std::string> told_;
};

std::uint32_t last_tick_of(const fs::path& path) {
  const ilk_replay_report_t report = recorder_test::replayed(path);
  EXPECT_TRUE(ilk_replay_is_identical(&report));
  return report.replay.last_tick;
}

TEST_F(RescueTest, RingOfADeadKernelIsWrittenOutWholeAndGone) {
  Rescue begun = rescue();
  save(begun);
  EXPECT_TRUE(begun.is_done());
  EXPECT_THAT(recordings(), ElementsAre(HasSubstr("-rescue-")));
  EXPECT_EQ(last_tick_of(recordings().front()), 900U);
  EXPECT_FALSE(fs::exists(ring_file_));
}

TEST_F(RescueTest, RingOfALivingKernelIsNeverTakenUnderAnyName) {
  RecordedRun living(ring_file_, 1, 4);
  living.calm(20);
  fs::remove(before_);
  fs::create_hard_link(ring_file_, before_);
  Rescue begun = rescue();
  save(begun);
  EXPECT_TRUE(recordings().empty());
  EXPECT_TRUE(fs::exists(ring_file_));
  EXPECT_TRUE(fs::exists(before_));
}

TEST_F(RescueTest, KernelRefusesTheRingOfOneThatLives) {
  RecordedRun living(ring_file_, 1, 4);
  living.calm(20);
  ilk_config_t config{};
  config.period_us = 1000;
  const ilk_black_box_terms_t terms{&config, ILK_CLOCK_SIM, true, 1};
  const auto second = std::make_unique<ilk_black_box_t>();
  ilk_error_t error{};
  EXPECT_FALSE(ilk_black_box_create(second.get(), ring_file_.c_str(), &terms, &error));
  EXPECT_THAT(error.text, HasSubstr("a kernel that runs"));
  living.calm(20);
  const Recorded<Ring> ring = Ring::open(ring_file_);
  ASSERT_TRUE(ring) << ring.error();
  EXPECT_TRUE(ring->writer_lives());
}

TEST_F(RescueTest, KernelThatStartsLeavesTheRingBeforeAName) {
  RecordedRun living(ring_file_, 1, 4);
  living.calm(20);
  Rescue begun = rescue();
  save(begun);
  ASSERT_EQ(recordings().size(), 1U);
  EXPECT_EQ(last_tick_of(recordings().front()), 900U);
  EXPECT_FALSE(fs::exists(before_));
  EXPECT_TRUE(fs::exists(ring_file_)) << "the living kernel's";
}

TEST_F(RescueTest, RingThatTheDiskRefusesWaitsAndIsWrittenOutLater) {
  refuse();
  {
    Rescue begun = rescue();
    save(begun);
    EXPECT_FALSE(begun.is_done());
  }
  EXPECT_THAT(told_, ElementsAre(HasSubstr("keep it in memory")));
  leave_ring(50);
  EXPECT_TRUE(fs::exists(before_));
  take();
  Rescue again = rescue();
  save(again);
  ASSERT_EQ(recordings().size(), 2U);
  EXPECT_EQ(last_tick_of(recordings()[0]) + last_tick_of(recordings()[1]), 950U);
  EXPECT_FALSE(fs::exists(before_));
  EXPECT_FALSE(fs::exists(ring_file_));
}

TEST_F(RescueTest, RingThatWaitsIsNotReplacedByALaterOne) {
  leave_ring(50);
  leave_ring(70);
  Rescue begun = rescue();
  save(begun);
  ASSERT_EQ(recordings().size(), 2U);
  EXPECT_EQ(last_tick_of(recordings()[0]) + last_tick_of(recordings()[1]), 970U) << "the first and the last";
}

TEST_F(RescueTest, FileThatIsRemovedBeforeAllIsWrittenDoesNotCountAsKept) {
  fs::remove(ring_file_);
  leave_ring(6000);
  Rescue begun = rescue();
  begun.look();
  begun.step();
  ASSERT_EQ(recordings().size(), 1U);
  EXPECT_EQ(recordings().front().extension(), ".part") << "a step writes a few blocks only";
  fs::remove(recordings().front());
  save(begun);
  EXPECT_FALSE(begun.is_done());
  EXPECT_TRUE(recordings().empty());
  EXPECT_TRUE(fs::exists(ring_file_));
}

// A recorder that began beside a kernel took the ring away that the kernel was making.
TEST_F(RescueTest, RingThatAKernelIsJustMakingIsLeftAlone) {
  std::fstream(ring_file_, std::ios::in | std::ios::out | std::ios::binary).put('\0');
  Rescue begun = rescue();
  save(begun);
  EXPECT_TRUE(told_.empty());
  EXPECT_TRUE(fs::exists(ring_file_));
}

TEST_F(RescueTest, RingOfAnotherReleaseIsToldOnceAndLeftToAPerson) {
  constexpr std::streamoff layout =
      offsetof(ilk_ring_header_t, run) + offsetof(ilk_run_description_t, layout_hash);
  std::fstream(ring_file_, std::ios::in | std::ios::out | std::ios::binary).seekp(layout).put('?');
  Rescue begun = rescue();
  save(begun);
  save(begun);
  EXPECT_THAT(told_, ElementsAre(HasSubstr("another release")));
  EXPECT_TRUE(fs::exists(ring_file_));
  EXPECT_TRUE(recordings().empty());
}

}  // namespace
}  // namespace interlock::recorder
