/**
 * @file
 * Commands that wait for their tick.
 */
#ifndef INTERLOCK_PLANT_SCHEDULE_HPP
#define INTERLOCK_PLANT_SCHEDULE_HPP

#include <algorithm>
#include <vector>

#include "plant/command.hpp"

namespace interlock::plant {

/** Bounded, ordered by tick, then by arrival. Never allocates after construction. */
class Schedule {
 public:
  static constexpr std::size_t kCapacity = 4096;

  Schedule() { latest_first_.reserve(kCapacity); }

  bool is_full() const { return latest_first_.size() == kCapacity; }

  /** Adds a command; the schedule is not full. */
  void add(std::uint64_t tick, const command::Command& what) {
    const auto place = std::lower_bound(latest_first_.begin(), latest_first_.end(), tick,
                                        [](const Entry& entry, std::uint64_t at) { return entry.tick > at; });
    latest_first_.insert(place, {tick, what});
  }

  /** Takes the next command whose tick has come. */
  std::optional<command::Command> take_due(std::uint64_t tick) {
    if (latest_first_.empty() || latest_first_.back().tick > tick) {
      return std::nullopt;
    }
    const command::Command what = latest_first_.back().what;
    latest_first_.pop_back();
    return what;
  }

 private:
  struct Entry {
    std::uint64_t tick;
    command::Command what;
  };

  std::vector<Entry> latest_first_;
};

}  // namespace interlock::plant

#endif
