/**
 * @file
 * What dead kernels left in memory: written out whole, now or when the disk takes it.
 */
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <set>
#include <string>

#include "recorder/recorder.hpp"
#include "recorder/recording_folder.hpp"
#include "recorder/recording_writer.hpp"
#include "recorder/ring.hpp"

namespace interlock::recorder {

/**
 * Keeps the rings of dead kernels until they are on the disk. The ring of the last kernel stands under its
 * own name; a kernel that starts leaves the ring of the one before under a second name (black_box.h).
 * Whatever stands there is known by its file and not by its name, so that a ring of a kernel that lives is
 * never taken.
 */
class Rescue {
 public:
  /** `ring` is where kernels make theirs. */
  Rescue(std::filesystem::path ring, const RecordingFolder& folder, std::string build, Tell tell);

  /** Looks for rings of dead kernels; `followed` is one that somebody else keeps. */
  void look(const Ring* followed = nullptr);

  /** Takes over a ring of which not all that is to be kept is on the disk. */
  void take(Ring ring);

  /** Writes the next blocks, if the disk may be asked. */
  void step();

  /** Removes the file of a ring that is on the disk, under whichever name it stands. */
  void let_go(const Ring& ring) const;

  [[nodiscard]] bool is_done() const { return jobs_.empty(); }

 private:
  struct Job {
    Ring ring;
    std::filesystem::path file;
    std::optional<RecordingWriter> writer;
    std::uint32_t next_block;
  };

  void look_at(const std::filesystem::path& file, const Ring* followed);
  [[nodiscard]] Recorded<void> begin(Job& job);
  [[nodiscard]] Recorded<void> write_some(Job& job);
  void fail(Job& job, const std::string& reason);

  std::filesystem::path ring_;
  const RecordingFolder& folder_;
  std::string build_;
  Tell tell_;
  std::deque<Job> jobs_;
  std::set<std::filesystem::path> told_; /**< names at which another release's ring was told */
  std::chrono::steady_clock::time_point retry_at_;
};

}  // namespace interlock::recorder
