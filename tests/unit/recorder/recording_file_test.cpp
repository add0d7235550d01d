#include "interlock/recording_file.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "recorded_run.hpp"
#include "recorder/recorder.hpp"

namespace interlock::recorder {
namespace {

using recorder_test::RecordedRun;
using recorder_test::ScratchFolder;

/** What reading a whole file came to. */
struct Reading {
  ilk_header_result_t header = ILK_HEADER_GOOD;
  std::vector<std::uint32_t> blocks; /**< numbers of those that were believed */
  ilk_file_result_t end = ILK_FILE_END;
  std::uint32_t broken = 0; /**< number of the block that was not */
  std::uint64_t offset = 0; /**< of it in the file */
};

Reading read(const std::filesystem::path& path) {
  const std::unique_ptr<FILE, int (*)(FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  const auto recording = std::make_unique<ilk_recording_t>();
  Reading reading;
  reading.header = ilk_recording_begin(recording.get(), file.get());
  while (reading.header == ILK_HEADER_GOOD) {
    reading.end = ilk_recording_next(recording.get());
    reading.offset = recording->offset;
    if (reading.end != ILK_FILE_BLOCK) {
      reading.broken = recording->number;
      break;
    }
    reading.blocks.push_back(recording->number);
  }
  return reading;
}

/** A file of four blocks, and its bytes to be spoilt. */
class RecordingFile : public ::testing::Test {
 protected:
  void SetUp() override {
    RecordedRun run(11);
    run.run(1800);
    ASSERT_TRUE(record_now(run.ring(), path_, {ILK_RECORDED_ON_DEMAND, 1800, "test"}, 60));
    std::ifstream file(path_, std::ios::binary);
    bytes_.assign(std::istreambuf_iterator<char>(file), {});
    whole_ = read(path_);
    ASSERT_EQ(whole_.end, ILK_FILE_END);
    ASSERT_GE(whole_.blocks.size(), 3U);
  }

  Reading read_spoilt(const std::string& bytes) {
    std::ofstream(path_, std::ios::binary | std::ios::trunc) << bytes;
    return read(path_);
  }

  ScratchFolder scratch_;
  std::filesystem::path path_ = scratch_.file("recording.ilkr");
  std::string bytes_;
  Reading whole_;
};

TEST_F(RecordingFile, CutAtAnyPlaceLosesTheLastBlockOnly) {
  std::mt19937 dice(1);
  std::uniform_int_distribution<std::size_t> place(sizeof(ilk_recording_header_t), bytes_.size() - 1);
  for (int n = 0; n < 60; ++n) {
    const std::size_t length = place(dice);
    const Reading cut = read_spoilt(bytes_.substr(0, length));
    ASSERT_NE(cut.end, ILK_FILE_DAMAGED) << length;
    ASSERT_LE(cut.offset, length);
    ASSERT_LT(cut.blocks.size(), whole_.blocks.size());
    const std::vector<std::uint32_t> first(whole_.blocks.begin(),
                                           whole_.blocks.begin() + static_cast<long>(cut.blocks.size()));
    ASSERT_EQ(cut.blocks, first);
  }
}

TEST_F(RecordingFile, TailThatWasNeverWrittenIsATornBlock) {
  std::string unwritten = bytes_;
  unwritten.replace(unwritten.size() - 5000, 5000, 5000, '\0');
  const Reading reading = read_spoilt(unwritten);
  EXPECT_EQ(reading.end, ILK_FILE_TORN);
  EXPECT_EQ(reading.blocks.size(), whole_.blocks.size() - 1);
  EXPECT_EQ(read_spoilt(bytes_ + std::string(8192, '\0')).end, ILK_FILE_TORN);
}

TEST_F(RecordingFile, FlippedBitIsFoundInItsBlock) {
  std::mt19937 dice(2);
  std::uniform_int_distribution<std::size_t> place(sizeof(ilk_recording_header_t) * 8, bytes_.size() * 8 - 1);
  for (int n = 0; n < 100; ++n) {
    const std::size_t bit = place(dice);
    std::string spoilt = bytes_;
    spoilt[bit / 8] = static_cast<char>(spoilt[bit / 8] ^ (1 << (bit % 8)));
    const Reading reading = read_spoilt(spoilt);
    ASSERT_EQ(reading.end, ILK_FILE_DAMAGED) << bit;
    ASSERT_LE(reading.offset, bit / 8);
    ASSERT_LT(reading.blocks.size(), whole_.blocks.size());
  }
}

TEST_F(RecordingFile, FlippedBitOfTheHeaderIsRefused) {
  for (std::size_t byte = 0; byte < sizeof(ilk_recording_header_t); byte += 7) {
    std::string spoilt = bytes_;
    spoilt[byte] = static_cast<char>(spoilt[byte] ^ 0x10);
    ASSERT_NE(read_spoilt(spoilt).header, ILK_HEADER_GOOD) << byte;
  }
}

TEST_F(RecordingFile, OtherFilesAreNoRecordings) {
  EXPECT_EQ(read_spoilt("").header, ILK_HEADER_NO_RECORDING);
  EXPECT_EQ(read_spoilt(std::string(100'000, 'x')).header, ILK_HEADER_NO_RECORDING);
}

}  // namespace
}  // namespace interlock::recorder
