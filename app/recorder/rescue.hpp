/**
 * @file
 * What a dead kernel left in memory: written out, now or when the disk takes it.
 */
#pragma once

#include <chrono>
#include <filesystem>
#include <string>

#include "recorder/recorder.hpp"
#include "recorder/recording_folder.hpp"

namespace interlock::recorder {

/** Beside the ring's file: a ring that the disk refused. The next kernel takes the ring's own name. */
std::filesystem::path unsaved_of(const std::filesystem::path& ring);

/** Beside the ring's file: a ring that this release cannot read, left to a person. */
std::filesystem::path unreadable_of(const std::filesystem::path& ring);

/**
 * Keeps the rings of dead kernels until they are on the disk. A ring is set aside first, so that the next
 * kernel does not take its place, and tried again while the disk refuses it. One can wait at a time.
 */
class Rescue {
 public:
  /** `ring` is where kernels make theirs. */
  Rescue(std::filesystem::path ring, const RecordingFolder& folder, RecorderTerms terms, Tell tell);

  /** Takes over what an earlier run left, its kernel and its recorder being dead. */
  void begin();

  /** Sets the ring of a kernel that died aside, unless an earlier one still waits there. */
  void set_aside();

  /** Lets the ring that was set aside go when all of it that is to be kept is on the disk. */
  void settle(bool kept);

  /** Writes out what was set aside, if the disk may be asked again. */
  void step();

 private:
  [[nodiscard]] bool write_out(const Ring& ring, std::uint32_t first_block);
  void keep_unreadable(const std::filesystem::path& ring);

  std::filesystem::path ring_;
  const RecordingFolder& folder_;
  RecorderTerms terms_;
  Tell tell_;
  bool aside_ = false; /**< the newest dead kernel's ring, not an earlier one */
  std::chrono::steady_clock::time_point retry_at_;
};

}  // namespace interlock::recorder
