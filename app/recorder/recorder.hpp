/**
 * @file
 * What is kept of a run: all of it, or the time around each event. Copies the kernel's black box to the disk,
 * and never touches its loop.
 */
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "recorder/recording_folder.hpp"
#include "recorder/recording_writer.hpp"
#include "recorder/ring.hpp"

namespace interlock::recorder {

/** After the disk refused: a full one does not get free sooner by asking at every step. */
constexpr std::chrono::seconds pause_after_failure{10};

/** What is recorded, and how much of it. */
struct RecorderTerms {
  bool continuous = false;
  std::uint32_t before_s = 60; /**< of kernel time, that a recording of an event holds before it */
  std::uint32_t after_s = 2;   /**< of kernel time, after it */
  std::uint64_t part_bytes = std::uint64_t{256}
                             << 20; /**< at which a continuous recording goes on in a new file */
  std::string build;
};

/** What the recorder has to tell: "recording FILE", "FILE is complete", or why something failed. */
using Tell = std::function<void(const std::string&)>;

/**
 * Follows one ring. An event is the kernel's locking, an axis' fault, or an end of the kernel out of order; a
 * recording begins `before_s` before it, and ends `after_s` after it or after the last event that came
 * meanwhile.
 *
 * Starting again on the same ring comes to the same recordings; those that are complete already stay as they
 * are. What the disk refuses is tried again, from where it was refused, for as long as the ring holds it.
 */
class Recorder {
 public:
  Recorder(const Ring& ring, const RecordingFolder& folder, RecorderTerms terms, Tell tell);

  /** Takes in what has come since the last call. */
  void step();

  /**
   * Writes out all there is; after the kernel's end, or when the recorder itself is to end. False when the
   * disk did not take all that is to be kept: the ring alone holds it.
   */
  [[nodiscard]] bool finish();

 private:
  /** What is to be kept, until a recording of it is begun. */
  struct Event {
    ilk_recorded_why_t why;
    std::uint32_t tick;
    std::uint32_t last_tick;
  };

  /** A recording that is being written; without a writer, one that is complete already. */
  struct Active {
    ilk_recorded_why_t why;
    std::uint32_t tick;
    std::filesystem::path file;
    std::optional<RecordingWriter> writer = std::nullopt;
    std::uint32_t first_block;
    std::uint32_t next_block;
    /** Nothing: goes on. */
    std::optional<std::uint32_t> last_tick = std::nullopt;
    /** By the disk, when it was asked last. */
    bool refused = false;
    /** What a recorder before had of it, until this has all of that. */
    std::optional<std::filesystem::path> cut = std::nullopt;
  };

  void report_shortage();
  void take_in(const TickHead& head);
  void event(ilk_recorded_why_t why, std::uint32_t tick);
  void begin_recording();
  void begin(ilk_recorded_why_t why, std::uint32_t tick, std::uint32_t first_block);
  void set_aside(Active& recording) const;
  [[nodiscard]] bool create(Active& recording);
  [[nodiscard]] bool resume();
  void append_complete_blocks();
  [[nodiscard]] bool append_next();
  void end_recording();
  [[nodiscard]] bool is_over() const;
  void complete();
  void fail(const std::string& reason);
  [[nodiscard]] bool may_write() const;

  const Ring& ring_;
  const RecordingFolder& folder_;
  RecorderTerms terms_;
  Tell tell_;
  RingPlace place_;
  std::optional<TickHead> newest_;
  std::optional<Event> event_;
  std::optional<Active> active_;
  double held_s_;                                  /**< that the ring holds, as reported */
  std::uint32_t continuous_next_ = 0;              /**< first block that no continuous recording has */
  std::chrono::steady_clock::time_point retry_at_; /**< after the disk refused */
};

/** Writes the newest `seconds` of kernel time into a new file; returns how many blocks. */
Recorded<std::uint32_t> record_now(const Ring& ring, const std::filesystem::path& file,
                                   const RecordingSubject& subject, std::uint32_t seconds);

}  // namespace interlock::recorder
