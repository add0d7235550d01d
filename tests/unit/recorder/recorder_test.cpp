#include "recorder/recorder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "recorded_run.hpp"

namespace interlock::recorder {
namespace {

namespace fs = std::filesystem;
using recorder_test::RecordedRun;
using recorder_test::replayed;
using recorder_test::ScratchFolder;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

/** A kernel that is calm until the test makes something happen, and its recorder: 1 s before, 0 s after. */
class RecorderTest : public ::testing::Test {
 protected:
  void SetUp() override {
    recorder_.emplace(ring_, *folder_, terms_, [](const std::string&) {});
    run_.calm(50);
    run_.ask(ILK_REQUEST_RESET);
    ASSERT_EQ(run_.state().system.mode, ILK_MODE_READY);
    recorder_->step();
  }

  /** Calm ticks, looked at as often as the recorder's process would. */
  void calm(std::uint32_t ticks) {
    for (std::uint32_t n = 0; n < ticks; n += 20) {
      run_.calm(20);
      recorder_->step();
    }
  }

  [[nodiscard]] std::set<std::string> files() const {
    std::set<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(scratch_.file("recordings"))) {
      const std::string name = entry.path().filename();
      names.insert(name.substr(name.find('-') + 1));
    }
    return names;
  }

  [[nodiscard]] fs::path file(ilk_recorded_why_t why, std::uint32_t tick) const {
    return folder_->file(ring_.run(), why, tick);
  }

  ScratchFolder scratch_;
  RecordedRun run_{1, 4};
  Ring ring_ = run_.ring();
  Recorded<RecordingFolder> folder_ = RecordingFolder::open(scratch_.file("recordings"), 1ULL << 30);
  RecorderTerms terms_{.before_s = 1, .after_s = 1, .build = "test"};
  std::optional<Recorder> recorder_;
};

TEST_F(RecorderTest, CalmRunLeavesNoRecording) {
  calm(2000);
  run_.close();
  EXPECT_TRUE(recorder_->finish());
  EXPECT_THAT(files(), IsEmpty());
}

TEST_F(RecorderTest, LockIsRecordedWithTheTimeBeforeAndAfterIt) {
  calm(3000);
  run_.press_estop();
  const std::uint32_t locked = run_.state().system.tick;
  ASSERT_EQ(run_.state().system.mode, ILK_MODE_LOCKED);
  calm(400);
  EXPECT_THAT(files(), ElementsAre("lock-" + std::to_string(locked) + ".ilkr.part"));
  calm(1000);
  EXPECT_THAT(files(), ElementsAre("lock-" + std::to_string(locked) + ".ilkr"));
  const ilk_replay_report_t report = replayed(file(ILK_RECORDED_ON_LOCK, locked));
  EXPECT_TRUE(ilk_replay_is_identical(&report));
  EXPECT_LE(report.replay.first_tick, locked - 1000);
  EXPECT_GT(report.replay.first_tick, 1U);
  EXPECT_GE(report.replay.last_tick, locked + 1000);
  EXPECT_LE(report.replay.last_tick, locked + 1020);
}

TEST_F(RecorderTest, AxisFaultIsRecorded) {
  calm(100);
  run_.make_jump(4);
  const std::uint32_t faulted = run_.state().system.tick;
  ASSERT_EQ(run_.state().axis[4].state, ILK_AXIS_FAULTED);
  calm(1200);
  EXPECT_THAT(files(), ElementsAre("fault-" + std::to_string(faulted) + ".ilkr"));
}

TEST_F(RecorderTest, EventsThatFollowEachOtherAreOneRecordingUntilTheLast) {
  calm(100);
  run_.make_jump(4);
  const std::uint32_t faulted = run_.state().system.tick;
  calm(900);
  run_.press_estop();
  const std::uint32_t locked = run_.state().system.tick;
  calm(1200);
  EXPECT_THAT(files(), ElementsAre("fault-" + std::to_string(faulted) + ".ilkr"));
  EXPECT_GE(replayed(file(ILK_RECORDED_ON_FAULT, faulted)).replay.last_tick, locked + 1000);
}

TEST_F(RecorderTest, KilledKernelsLastTicksAreKept) {
  calm(1500);
  run_.calm(7);
  const std::uint32_t last = run_.state().system.tick;
  run_.die();
  EXPECT_TRUE(recorder_->finish());
  EXPECT_THAT(files(), ElementsAre("end-" + std::to_string(last) + ".ilkr"));
  const ilk_replay_report_t report = replayed(file(ILK_RECORDED_ON_END, last));
  EXPECT_TRUE(ilk_replay_is_identical(&report));
  EXPECT_EQ(report.replay.last_tick, last);
}

TEST_F(RecorderTest, KilledRecorderStartedAgainComesToTheSameRecordings) {
  calm(200);
  run_.press_estop();
  const std::uint32_t first = run_.state().system.tick;
  calm(1200);
  run_.ask(ILK_REQUEST_RESET);
  run_.press_estop();
  const std::uint32_t second = run_.state().system.tick;
  calm(300);
  const auto written = fs::last_write_time(file(ILK_RECORDED_ON_LOCK, first));
  recorder_.emplace(ring_, *folder_, terms_, [](const std::string&) {});
  calm(1200);
  EXPECT_THAT(files(), UnorderedElementsAre("lock-" + std::to_string(first) + ".ilkr",
                                            "lock-" + std::to_string(second) + ".ilkr"));
  EXPECT_EQ(fs::last_write_time(file(ILK_RECORDED_ON_LOCK, first)), written);
  const ilk_replay_report_t report = replayed(file(ILK_RECORDED_ON_LOCK, second));
  EXPECT_TRUE(ilk_replay_is_identical(&report));
}

TEST_F(RecorderTest, ContinuousRecordingLosesNoTickFromPartToPart) {
  terms_.continuous = true;
  terms_.part_bytes = 40'000;
  recorder_.emplace(ring_, *folder_, terms_, [](const std::string&) {});
  calm(3000);
  run_.press_estop();
  calm(1000);
  run_.close();
  EXPECT_TRUE(recorder_->finish());
  std::uint64_t ticks = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_->path())) {
    EXPECT_EQ(entry.path().extension(), ".ilkr");
    const ilk_replay_report_t report = replayed(entry.path());
    EXPECT_TRUE(ilk_replay_is_identical(&report));
    EXPECT_EQ(report.replay.gaps, 0U);
    ticks += report.replay.ticks;
  }
  EXPECT_GT(files().size(), 2U);
  EXPECT_EQ(ticks, run_.state().system.tick);
}

TEST_F(RecorderTest, WholeBlocksOfAContinuousRecordingAreInTheFileAtOnce) {
  terms_.continuous = true;
  recorder_.emplace(ring_, *folder_, terms_, [](const std::string&) {});
  calm(3000);
  ASSERT_EQ(files().size(), 1U);
  const ilk_replay_report_t report = replayed(part_of(file(ILK_RECORDED_CONTINUOUSLY, 0)));
  EXPECT_TRUE(ilk_replay_is_identical(&report));
  EXPECT_EQ(report.replay.last_tick, *ring_.opening_tick(ring_.head()));
}

TEST_F(RecorderTest, DemandKeepsTheNewestSeconds) {
  calm(3000);
  const Recorded<std::uint32_t> blocks = record_now(
      ring_, scratch_.file("now.ilkr"), {ILK_RECORDED_ON_DEMAND, run_.state().system.tick, "test"}, 1);
  ASSERT_TRUE(blocks);
  const ilk_replay_report_t report = replayed(scratch_.file("now.ilkr"));
  EXPECT_TRUE(ilk_replay_is_identical(&report));
  EXPECT_EQ(report.replay.last_tick, run_.state().system.tick);
  EXPECT_LE(report.replay.first_tick, run_.state().system.tick - 999);
  EXPECT_GT(report.replay.first_tick, 1U);
}

TEST_F(RecorderTest, OldestRecordingsMakeRoomForNewOnes) {
  for (const char* const name : {"a.ilkr", "b.ilkr", "c.ilkr"}) {
    std::ofstream(folder_->path() / name) << std::string(1000, 'x');
  }
  fs::last_write_time(folder_->path() / "b.ilkr", fs::file_time_type::min() + std::chrono::hours(1));
  const Recorded<RecordingFolder> small = RecordingFolder::open(folder_->path(), 2000);
  ASSERT_TRUE(small);
  small->make_room();
  EXPECT_TRUE(fs::exists(folder_->path() / "a.ilkr"));
  EXPECT_FALSE(fs::exists(folder_->path() / "b.ilkr"));
  EXPECT_TRUE(fs::exists(folder_->path() / "c.ilkr"));
}

TEST_F(RecorderTest, CutOffRecordingOfAnEarlierRunIsKept) {
  std::ofstream(folder_->path() / "x-lock-7.ilkr.part") << "cut off";
  run_.press_estop();
  const std::uint32_t locked = run_.state().system.tick;
  calm(100);
  folder_->finish_parts(&ring_.run());
  const std::string going_on = "lock-" + std::to_string(locked) + ".ilkr";
  EXPECT_THAT(files(), UnorderedElementsAre("lock-7.ilkr", going_on + ".part"));
  folder_->finish_parts(nullptr);
  EXPECT_THAT(files(), UnorderedElementsAre("lock-7.ilkr", going_on + ".part"))
      << "it is still being written";
  recorder_.reset();
  folder_->finish_parts(nullptr);
  EXPECT_THAT(files(), UnorderedElementsAre("lock-7.ilkr", going_on));
}

TEST_F(RecorderTest, FullDiskIsToldAndTheKernelIsNotAsked) {
  std::vector<std::string> told;
  fs::remove_all(folder_->path());
  recorder_.emplace(ring_, *folder_, terms_, [&](const std::string& line) { told.push_back(line); });
  run_.press_estop();
  calm(100);
  EXPECT_THAT(told, ElementsAre(::testing::HasSubstr("cannot record")));
}

/** The disk takes no file beyond this size; at the limit a block is written in part. */
class FileSizeLimit {
 public:
  explicit FileSizeLimit(std::uintmax_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, SIG_DFL);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
};

TEST_F(RecorderTest, EventThatTheDiskRefusedIsRecordedOnceItTakesIt) {
  calm(1500);
  fs::rename(folder_->path(), scratch_.file("away"));
  run_.press_estop();
  const std::uint32_t locked = run_.state().system.tick;
  calm(1200);
  EXPECT_FALSE(recorder_->finish());
  fs::rename(scratch_.file("away"), folder_->path());
  EXPECT_TRUE(recorder_->finish());
  EXPECT_THAT(files(), ElementsAre("lock-" + std::to_string(locked) + ".ilkr"));
  const ilk_replay_report_t report = replayed(file(ILK_RECORDED_ON_LOCK, locked));
  EXPECT_TRUE(ilk_replay_is_identical(&report));
  EXPECT_LE(report.replay.first_tick, locked - 1000);
  EXPECT_EQ(report.replay.last_tick, run_.state().system.tick);
}

TEST_F(RecorderTest, EventWhoseTimeIsNotOverIsLeftUnfinishedForTheNextRecorder) {
  calm(200);
  run_.press_estop();
  const std::uint32_t locked = run_.state().system.tick;
  calm(300);
  EXPECT_FALSE(recorder_->finish()) << "asked to end beside a living kernel";
  EXPECT_THAT(files(), ElementsAre("lock-" + std::to_string(locked) + ".ilkr.part"));
  recorder_.emplace(ring_, *folder_, terms_, [](const std::string&) {});
  calm(1200);
  EXPECT_THAT(files(), ElementsAre("lock-" + std::to_string(locked) + ".ilkr"));
  EXPECT_GE(replayed(file(ILK_RECORDED_ON_LOCK, locked)).replay.last_tick, locked + 1000);
}

TEST_F(RecorderTest, UnfinishedRecordingThatHoldsMoreThanTheRingIsKept) {
  calm(1500);
  run_.press_estop();
  const std::uint32_t locked = run_.state().system.tick;
  calm(300);
  recorder_.reset();
  while (*ring_.opening_tick(ring_.oldest()) < locked - 500) {
    run_.calm(20);
  }
  recorder_.emplace(ring_, *folder_, terms_, [](const std::string&) {});
  recorder_->step();
  run_.calm(20);
  recorder_->step();
  ASSERT_EQ(files().size(), 2U);
  const fs::path whole = file(ILK_RECORDED_ON_LOCK, locked);
  const ilk_replay_report_t cut = replayed(whole.parent_path() / (whole.stem().string() + "-cut-1.ilkr"));
  EXPECT_LE(cut.replay.first_tick, locked - 1000);
  EXPECT_GE(replayed(whole).replay.last_tick, locked + 1000);
}

// The newest block was copied while it was being written, and stood for the whole one.
TEST_F(RecorderTest, RecordingThatCannotGetItsNameYetHasNoHole) {
  calm(1500);
  run_.press_estop();
  const std::uint32_t locked = run_.state().system.tick;
  calm(500);
  fs::rename(folder_->path(), scratch_.file("away"));
  calm(1500);
  fs::rename(scratch_.file("away"), folder_->path());
  EXPECT_TRUE(recorder_->finish());
  const ilk_replay_report_t report = replayed(file(ILK_RECORDED_ON_LOCK, locked));
  EXPECT_TRUE(ilk_replay_is_identical(&report));
  EXPECT_EQ(report.replay.gaps, 0U);
  EXPECT_GE(report.replay.last_tick, locked + 1000);
}

TEST_F(RecorderTest, RecordingWhoseFileIsRemovedWhileTheDiskIsFullIsWrittenAnew) {
  calm(1500);
  run_.press_estop();
  const std::uint32_t locked = run_.state().system.tick;
  calm(20);
  const fs::path part = part_of(file(ILK_RECORDED_ON_LOCK, locked));
  {
    const FileSizeLimit full(fs::file_size(part) + 1000);
    calm(1200);
    EXPECT_FALSE(recorder_->finish());
    fs::remove(part);
  }
  calm(600);
  EXPECT_TRUE(recorder_->finish());
  const ilk_replay_report_t report = replayed(file(ILK_RECORDED_ON_LOCK, locked));
  EXPECT_TRUE(ilk_replay_is_identical(&report));
  EXPECT_LE(report.replay.first_tick, locked - 1000);
  EXPECT_EQ(report.replay.last_tick, run_.state().system.tick);
}

TEST_F(RecorderTest, ContinuousRecordingThatTheDiskRefusedGoesOnWithTheBlockThatItRefused) {
  terms_.continuous = true;
  terms_.part_bytes = 40'000;
  recorder_.emplace(ring_, *folder_, terms_, [](const std::string&) {});
  calm(1500);
  fs::rename(folder_->path(), scratch_.file("away"));
  calm(1500);
  run_.press_estop();
  calm(100);
  EXPECT_FALSE(recorder_->finish());
  fs::rename(scratch_.file("away"), folder_->path());
  run_.close();
  EXPECT_TRUE(recorder_->finish());
  std::uint64_t ticks = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_->path())) {
    EXPECT_EQ(entry.path().extension(), ".ilkr");
    ticks += replayed(entry.path()).replay.ticks;
  }
  EXPECT_EQ(ticks, run_.state().system.tick);
}

TEST_F(RecorderTest, LastTicksOfADeadKernelThatTheDiskRefusesAreNotTakenForKept) {
  calm(100);
  fs::remove_all(folder_->path());
  run_.die();
  EXPECT_FALSE(recorder_->finish());
}

TEST_F(RecorderTest, RecordingThatTheDiskInterruptedGoesOnWithTheSameBlock) {
  calm(1500);
  run_.press_estop();
  const std::uint32_t locked = run_.state().system.tick;
  calm(20);
  {
    const FileSizeLimit full(fs::file_size(part_of(file(ILK_RECORDED_ON_LOCK, locked))) + 1000);
    calm(1200);
    EXPECT_FALSE(recorder_->finish());
  }
  calm(400);
  EXPECT_TRUE(recorder_->finish());
  const ilk_replay_report_t report = replayed(file(ILK_RECORDED_ON_LOCK, locked));
  EXPECT_TRUE(ilk_replay_is_identical(&report));
  EXPECT_EQ(report.replay.gaps, 0U);
  EXPECT_LE(report.replay.first_tick, locked - 1000);
  EXPECT_EQ(report.replay.last_tick, run_.state().system.tick);
}

}  // namespace
}  // namespace interlock::recorder
