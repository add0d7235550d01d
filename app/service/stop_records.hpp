/**
 * @file
 * Records of the STOPs of those who are not logged in, whom nothing else slows: the first at once, then one
 * for all that come within a pause.
 */
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "service/clocks.hpp"
#include "store/audit.hpp"

namespace interlock {

class StopRecords {
 public:
  static constexpr std::chrono::seconds pause{5};

  /** A STOP, and `unrecorded` others just before it: what is to be recorded now. */
  std::optional<AuditEntry> add(AuditEntry entry, std::uint64_t unrecorded, SteadyTime now);

  /** The last STOP that waits, with the number of those before it as `unrecorded`, once the pause is over. */
  std::optional<AuditEntry> due(SteadyTime now);

  /** As `due`, whether the pause is over or not. */
  std::optional<AuditEntry> take();

 private:
  std::optional<AuditEntry> waiting_;
  std::uint64_t unrecorded_ = 0;
  std::optional<SteadyTime> recorded_;
};

}  // namespace interlock
