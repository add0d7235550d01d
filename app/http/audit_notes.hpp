/**
 * @file
 * Audit records that are written behind: they wait here, in their order, until the store takes them.
 */
#pragma once

#include <cstddef>
#include <list>
#include <mutex>

#include "store/audit.hpp"

namespace interlock::web {

/** Any thread may add; one thread at a time takes. */
class AuditNotes {
 public:
  /** Records that are written together. */
  using Batch = std::list<AuditEntry>;

  /** Records that wait, those that were taken and not confirmed among them. Beyond them the newest are lost;
   * a record of kind `records_lost` in their place says how many, and since when. */
  static constexpr std::size_t capacity = 4096;

  /** False: it is lost, and counted. */
  bool add(AuditEntry entry);

  /** Everything that waits, oldest first, to be written now and then either confirmed or given back. */
  Batch take();

  /** What was taken is on the disk. */
  void confirm();

  /** What was taken could not be written: it waits again, before whatever came meanwhile. */
  void give_back(Batch batch);

  /** Whether no record waits. */
  [[nodiscard]] bool empty() const;

 private:
  mutable std::mutex mutex_;
  Batch waiting_;
  std::size_t taken_ = 0;
};

}  // namespace interlock::web
