#include "service/stop_records.hpp"

#include <utility>

namespace interlock {

std::optional<AuditEntry> StopRecords::add(AuditEntry entry, std::uint64_t unrecorded, SteadyTime now) {
  unrecorded_ += unrecorded + (waiting_ ? 1 : 0);
  waiting_ = std::move(entry);
  return due(now);
}

std::optional<AuditEntry> StopRecords::due(SteadyTime now) {
  if (!waiting_ || (recorded_ && now - *recorded_ < pause)) {
    return std::nullopt;
  }
  recorded_ = now;
  return take();
}

std::optional<AuditEntry> StopRecords::take() {
  std::optional<AuditEntry> entry = std::exchange(waiting_, std::nullopt);
  if (const std::uint64_t before = std::exchange(unrecorded_, 0); entry && before != 0) {
    entry->detail["unrecorded"] = before;
  }
  return entry;
}

}  // namespace interlock
