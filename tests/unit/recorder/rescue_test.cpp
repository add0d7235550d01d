#include "recorder/rescue.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "interlock/replay.h"
#include "recorded_run.hpp"

namespace interlock::recorder {
namespace {

namespace fs = std::filesystem;
using recorder_test::RecordedRun;
using recorder_test::ScratchFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/** A kernel that died after some calm ticks, its ring left in memory. */
class RescueTest : public ::testing::Test {
 protected:
  void SetUp() override { leave_ring(900); }

  std::uint32_t leave_ring(std::uint32_t ticks) {
    RecordedRun run(ring_file_, 1, 4);
    run.calm(ticks);
    run.die();
    return run.state().tick;
  }

  Rescue rescue() {
    return {ring_file_, *folder_, RecorderTerms{.before_s = 1, .build = "test"},
            [this](const std::string& line) { told_.push_back(line); }};
  }

  [[nodiscard]] std::vector<fs::path> recordings() const {
    std::vector<fs::path> found;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_->path())) {
      found.push_back(entry.path());
    }
    return found;
  }

  void refuse() { fs::rename(folder_->path(), scratch_.file("away")); }
  void take() { fs::rename(scratch_.file("away"), folder_->path()); }

  ScratchFolder scratch_;
  fs::path ring_file_ = scratch_.file("ring");
  Recorded<RecordingFolder> folder_ = RecordingFolder::open(scratch_.file("recordings"), 1ULL << 30);
  std::vector<std::string> told_;
};

std::uint32_t last_tick_of(const fs::path& path) {
  const std::unique_ptr<FILE, int (*)(FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  const auto recording = std::make_unique<ilk_recording_t>();
  ilk_replay_report_t report{};
  EXPECT_EQ(ilk_recording_begin(recording.get(), file.get()), ILK_HEADER_GOOD) << path;
  ilk_replay_recording(recording.get(), &report, nullptr, nullptr);
  EXPECT_TRUE(ilk_replay_is_identical(&report));
  return report.replay.last_tick;
}

TEST_F(RescueTest, RingOfADeadKernelIsWrittenOutAndGone) {
  rescue().begin();
  EXPECT_THAT(recordings(), ElementsAre(HasSubstr("-rescue-")));
  EXPECT_EQ(last_tick_of(recordings().front()), 900U);
  EXPECT_FALSE(fs::exists(ring_file_));
  EXPECT_FALSE(fs::exists(unsaved_of(ring_file_)));
}

TEST_F(RescueTest, RingThatTheDiskRefusesWaitsOutOfTheNextKernelsWay) {
  refuse();
  rescue().begin();
  EXPECT_THAT(told_, ElementsAre(HasSubstr("cannot record"), HasSubstr("kept in memory")));
  const std::uint32_t later = leave_ring(50);
  EXPECT_TRUE(fs::exists(unsaved_of(ring_file_)));
  take();
  rescue().begin();
  ASSERT_EQ(recordings().size(), 2U);
  EXPECT_EQ(last_tick_of(recordings()[0]) + last_tick_of(recordings()[1]), 900U + later);
  EXPECT_FALSE(fs::exists(unsaved_of(ring_file_)));
}

TEST_F(RescueTest, SecondRingStaysWhereItIsWhileTheFirstWaits) {
  refuse();
  rescue().begin();
  leave_ring(50);
  rescue().begin();
  EXPECT_TRUE(fs::exists(ring_file_));
  EXPECT_TRUE(fs::exists(unsaved_of(ring_file_)));
  EXPECT_THAT(told_.back(), HasSubstr("an earlier one still waits"));
}

TEST_F(RescueTest, DiskIsNotAskedAtEveryStep) {
  refuse();
  Rescue waiting = rescue();
  waiting.begin();
  take();
  waiting.step();
  EXPECT_TRUE(recordings().empty());
}

// A recorder that began beside a kernel took the ring away that the kernel was making.
TEST_F(RescueTest, RingThatAKernelIsJustMakingIsLeftAlone) {
  std::fstream(ring_file_, std::ios::in | std::ios::out | std::ios::binary).put('\0');
  rescue().begin();
  EXPECT_TRUE(told_.empty());
  EXPECT_TRUE(fs::exists(ring_file_));
  EXPECT_FALSE(fs::exists(unreadable_of(ring_file_)));
}

TEST_F(RescueTest, RingOfAnotherReleaseIsLeftToAPerson) {
  constexpr std::streamoff layout =
      offsetof(ilk_ring_header_t, run) + offsetof(ilk_run_description_t, layout_hash);
  std::fstream(ring_file_, std::ios::in | std::ios::out | std::ios::binary).seekp(layout).put('?');
  rescue().begin();
  EXPECT_THAT(told_, ElementsAre(HasSubstr("another release")));
  EXPECT_TRUE(fs::exists(unreadable_of(ring_file_)));
  EXPECT_FALSE(fs::exists(ring_file_));
  EXPECT_TRUE(recordings().empty());
}

}  // namespace
}  // namespace interlock::recorder
