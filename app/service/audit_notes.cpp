#include <utility>

#include "service/store_executor.hpp"

namespace interlock {
namespace {

AuditEntry loss_of(const AuditEntry& first) {
  return {.time = first.time,
          .tick = first.tick,
          .actor = audit_actor::app,
          .session = std::nullopt,
          .kind = AuditKind::records_lost,
          .detail = {{"count", 1}}};
}

bool is_loss(const AuditEntry& entry) { return entry.kind == AuditKind::records_lost; }

void count_in(AuditEntry& loss, std::uint64_t more) {
  loss.detail["count"] = loss.detail["count"].get<std::uint64_t>() + more;
}

}  // namespace

bool AuditNotes::add(AuditEntry entry) {
  const std::lock_guard lock(mutex_);
  if (waiting_.size() + taken_ < capacity) {
    waiting_.push_back(std::move(entry));
    return true;
  }
  if (!waiting_.empty() && is_loss(waiting_.back())) {
    count_in(waiting_.back(), 1);
  } else {
    waiting_.push_back(loss_of(entry));
  }
  return false;
}

AuditNotes::Batch AuditNotes::take() {
  const std::lock_guard lock(mutex_);
  taken_ = waiting_.size();
  return std::exchange(waiting_, {});
}

void AuditNotes::confirm() {
  const std::lock_guard lock(mutex_);
  taken_ = 0;
}

void AuditNotes::give_back(Batch batch) {
  const std::lock_guard lock(mutex_);
  taken_ = 0;
  // Nothing was kept between two losses that follow one another: they are one.
  if (!batch.empty() && !waiting_.empty() && is_loss(batch.back()) && is_loss(waiting_.front())) {
    count_in(batch.back(), waiting_.front().detail["count"].get<std::uint64_t>());
    waiting_.pop_front();
  }
  waiting_.splice(waiting_.begin(), batch);
}

bool AuditNotes::empty() const {
  const std::lock_guard lock(mutex_);
  return waiting_.empty();
}

}  // namespace interlock
