/**
 * @file
 * The kernel's black box as its readers see it: shared memory that is written all the time (recording.h).
 */
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "interlock/recording.h"
#include "recorder/recorder_error.hpp"
#include "system/file_descriptor.hpp"

namespace interlock::recorder {

/** A block that was copied whole, up to the newest tick of that moment. */
struct BlockCopy {
  std::uint32_t number = 0;
  std::vector<std::uint32_t> payload;
};

/** Where the record of a tick stands. */
struct RingPlace {
  std::uint32_t block = 0; /**< number; 0: before the first */
  std::uint32_t word = 0;  /**< of the payload */
};

/** What the head of a tick's record says. */
struct TickHead {
  std::uint32_t tick = 0;
  std::uint32_t alarm = 0; /**< `ilk_alarm_of` */
};

/** Reads only; what the kernel has overwritten meanwhile is reported as gone, never mixed. */
class Ring {
 public:
  /** Gets the black box from the kernel that listens on this socket. */
  static Recorded<Ring> connect(const std::filesystem::path& socket);

  /** Maps the memory; `life` hangs up when the kernel ends. */
  static Recorded<Ring> map(FileDescriptor memory, FileDescriptor life);

  Ring(Ring&& other) noexcept;
  Ring& operator=(Ring&&) = delete;
  ~Ring();

  [[nodiscard]] const ilk_run_description_t& run() const { return header_->run; }

  /** Number of the block that is being written; 0 before the first. */
  [[nodiscard]] std::uint32_t head() const;

  /** Number of the oldest block that is not about to be overwritten. */
  [[nodiscard]] std::uint32_t oldest() const;

  /** The kernel said that it ended in order. */
  [[nodiscard]] bool closed() const;

  /** Seconds of kernel time that it was made for. */
  [[nodiscard]] std::uint32_t seconds() const { return header_->seconds; }

  /** The fewest seconds of kernel time that it ever held since it is full; nothing before. */
  [[nodiscard]] std::optional<double> fewest_seconds() const;

  /** The process that writes is there. */
  [[nodiscard]] bool writer_lives() const;

  /** The block as it is now; nothing when it was overwritten. */
  [[nodiscard]] std::optional<BlockCopy> copy(std::uint32_t number) const;

  /** Tick before the block's first one; nothing when it was overwritten. */
  [[nodiscard]] std::optional<std::uint32_t> opening_tick(std::uint32_t number) const;

  /** The newest block that begins so many seconds of kernel time before the tick or earlier; else the oldest.
   */
  [[nodiscard]] std::uint32_t block_before(std::uint32_t tick, std::uint32_t seconds) const;

  /** The record at a place that is advanced past it; nothing when there is none yet. A place that was
   * overwritten moves on to the oldest block. */
  [[nodiscard]] std::optional<TickHead> next(RingPlace& place) const;

 private:
  Ring(FileDescriptor life, const ilk_ring_header_t* header, std::size_t bytes)
      : life_(std::move(life)), header_(header), bytes_(bytes) {}

  [[nodiscard]] const ilk_block_header_t* block(std::uint32_t number) const;
  [[nodiscard]] std::optional<std::uint32_t> used(std::uint32_t number) const;
  [[nodiscard]] bool still_holds(std::uint32_t number) const;

  FileDescriptor life_;
  const ilk_ring_header_t* header_; /**< of the mapping */
  std::size_t bytes_;
};

}  // namespace interlock::recorder
