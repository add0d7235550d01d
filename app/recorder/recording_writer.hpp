/**
 * @file
 * Writes a recording so that a kill or a power cut costs its last block at most.
 */
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "interlock/recording_file.h"
#include "recorder/recorder_error.hpp"
#include "recorder/ring.hpp"
#include "system/file_descriptor.hpp"

namespace interlock::recorder {

/** What a recording is of. */
struct RecordingSubject {
  ilk_recorded_why_t why = ILK_RECORDED_CONTINUOUSLY;
  std::uint32_t tick = 0; /**< of the event */
  std::string build;      /**< version and commit of this program */
};

/** Writes one recording, block by block. */
class RecordingWriter {
 public:
  /** Begins the file anew, with its header on the disk. */
  static Recorded<RecordingWriter> create(const std::filesystem::path& file, const ilk_run_description_t& run,
                                          const RecordingSubject& subject);

  /** Appends a block; it is on the disk when this returns. After a failure nothing of it is in the file. */
  Recorded<void> append(const BlockCopy& block);

  /** Takes back the block that was appended last; false when that was done, or none was. */
  bool take_back_last();

  /** Takes the file up again after a failure; false when it is not there as it was left. */
  [[nodiscard]] bool reopen();

  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

 private:
  RecordingWriter(FileDescriptor file, std::string name) : file_(std::move(file)), name_(std::move(name)) {}

  Recorded<void> write(const void* bytes, std::size_t count);
  [[nodiscard]] Recorded<void> write_at_end(const void* bytes, std::size_t count);

  FileDescriptor file_;
  std::string name_;
  std::uint64_t bytes_ = 0;
  std::uint64_t last_bytes_ = 0; /**< of the block that was appended last */
};

}  // namespace interlock::recorder
