/**
 * @file
 * The plant's own record: what was on the wire and on the inputs, and when things last happened.
 */
#ifndef INTERLOCK_PLANT_RECORD_HPP
#define INTERLOCK_PLANT_RECORD_HPP

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "interlock/types.h"

namespace interlock::plant {

/** One exchange. */
struct RecordEntry {
  std::uint64_t tick = 0; /**< plant tick */
  std::uint32_t kernel_tick = 0;
  bool pedal_no_closed = false;
  bool pedal_nc_closed = false;
  bool estop_loop_closed = false;
  std::array<std::uint32_t, ILK_SLOTS> drive{};   /**< first drive word on the wire that is not zero */
  std::array<bool, ILK_SLOTS> amplifier{};        /**< after the card heard the frame */
  std::array<std::uint32_t, ILK_SLOTS> counter{}; /**< as the card stood before it, without noise */
};

enum class Event : std::uint8_t {
  kPedalReleased,    /**< the contacts no longer read pressed */
  kPedalPressed,     /**< both contacts read pressed */
  kEstopPulled,      /**< the loop reads open */
  kEstopReleased,    /**< the loop reads closed again */
  kLastNonzeroDrive, /**< a frame with a drive word that is not zero was on the wire */
  kAmplifiersOff,    /**< the last amplifier that was on went off */
  kKernelSilent,     /**< last exchange before a silence of 5 ms or more */
};

inline constexpr std::size_t kEventCount = 7;

/** A ring of the newest entries, and the newest tick of each event. Never allocates after construction. */
class Record {
 public:
  /** Two minutes at 1 kHz, and some. */
  static constexpr std::size_t kCapacity = std::size_t{1} << 17;

  Record() : entries_(kCapacity) {}

  void add(const RecordEntry& entry) {
    entries_[end_ % kCapacity] = entry;
    ++end_;
  }

  /** Entries are numbered from 0 in the order of exchanges; the oldest kept one is `begin()`. */
  std::uint64_t begin() const { return end_ > kCapacity ? end_ - kCapacity : 0; }
  std::uint64_t end() const { return end_; }

  /** The entry of that number, from `begin()` to `end()` - 1. */
  const RecordEntry& operator[](std::uint64_t number) const { return entries_[number % kCapacity]; }

  /** Number of the first kept entry at this plant tick or later; `end()` when there is none. */
  std::uint64_t find(std::uint64_t tick) const;

  void note(Event event, std::uint64_t tick) { events_[static_cast<std::size_t>(event)] = tick; }

  /** Plant tick at which the event last happened; nothing when it never did. */
  std::optional<std::uint64_t> newest(Event event) const { return events_[static_cast<std::size_t>(event)]; }

 private:
  std::vector<RecordEntry> entries_;
  std::uint64_t end_ = 0;
  std::array<std::optional<std::uint64_t>, kEventCount> events_{};
};

}  // namespace interlock::plant

#endif
