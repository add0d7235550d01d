/**
 * @file
 * The folder of the recordings: their names, and how much of them is kept.
 */
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "interlock/recording_file.h"
#include "recorder/recorder_error.hpp"

namespace interlock::recorder {

/** A finished recording ends with `.ilkr`; one that is being written, or was cut off, with `.ilkr.part`. */
class RecordingFolder {
 public:
  /** The folder is made if missing. */
  static Recorded<RecordingFolder> open(std::filesystem::path folder, std::uint64_t keep_bytes);

  /** Where a recording of that run and reason goes. */
  [[nodiscard]] std::filesystem::path file(const ilk_run_description_t& run, ilk_recorded_why_t why,
                                           std::uint32_t tick) const;

  /** Recordings that were cut off become finished ones, which end earlier but can be read: all but those of
   * the run that is still going on, if one is, and those that another recorder is still writing. */
  void finish_parts(const ilk_run_description_t* going_on) const;

  /** Removes the oldest finished recordings until those left are within the limit. */
  void make_room() const;

  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }

 private:
  RecordingFolder(std::filesystem::path folder, std::uint64_t keep_bytes)
      : folder_(std::move(folder)), keep_bytes_(keep_bytes) {}

  std::filesystem::path folder_;
  std::uint64_t keep_bytes_;
};

/** TIME-WHY-TICK.ilkr, TIME being that at which the kernel's run began: the same event has the same name. */
std::string recording_name(const ilk_run_description_t& run, ilk_recorded_why_t why, std::uint32_t tick);

/** The file while it is being written. */
std::filesystem::path part_of(const std::filesystem::path& file);

/** A free name for what was cut off of a recording: NAME-cut-N.ilkr. */
std::filesystem::path cut_of(const std::filesystem::path& file);

/** "lock", "fault" ...: as in the names of files. */
std::string why_name(std::uint32_t why);

/** Milliseconds since 1970, or nanoseconds, of two words. */
constexpr std::uint64_t joined(const std::uint32_t (&words)[2]) {
  return words[0] | (std::uint64_t{words[1]} << 32);
}

}  // namespace interlock::recorder
