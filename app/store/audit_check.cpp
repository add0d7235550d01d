#include "store/audit_check.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "store/audit_table.hpp"

namespace interlock {
namespace {

/** Whether this record says that those up to the anchor were removed. */
bool accounts_for(const AuditRecord& record, const AuditHead& anchor) {
  const auto detail = nlohmann::json::parse(record.detail, nullptr, false);
  return record.kind == "retention" && detail.is_object() &&
         detail.value("removed_to", nlohmann::json()) == anchor.number &&
         detail.value("hash", nlohmann::json()) == anchor.hash;
}

}  // namespace

void AuditCheck::begin(const AuditHead& anchor) {
  anchor_ = anchor;
  chain_ = AuditChain(anchor);
  accounted_ = anchor == AuditHead{};
  noted_found_ = !noted_ || *noted_ == anchor.hash;
}

bool AuditCheck::go_on(SQLite::Database& database, std::size_t count) {
  if (const AuditHead anchor = audit_anchor(database); anchor_ != anchor) {
    begin(anchor);
  }
  // Whatever stands before the anchor is looked at, too: nothing may.
  const bool first_part = chain_.head() == *anchor_;
  const std::int64_t from = first_part ? std::numeric_limits<std::int64_t>::min() : chain_.head().number + 1;
  SQLite::Statement records(database, std::string("SELECT ") + audit_columns +
                                          " FROM audit WHERE number >= ?1 ORDER BY number LIMIT ?2");
  records.bind(1, from);
  records.bind(2, static_cast<std::int64_t>(count));
  std::size_t followed = 0;
  for (; records.executeStep(); ++followed) {
    const AuditRecord record = audit_record(records);
    if (const auto next = chain_.follow(record); !next) {
      broken_ = next.error();
      return false;
    }
    accounted_ = accounted_ || accounts_for(record, *anchor_);
    noted_found_ = noted_found_ || *noted_ == chain_.head().hash;
  }
  return followed == count;
}

tl::expected<AuditHead, AuditBreak> AuditCheck::result() const {
  if (broken_) {
    return tl::unexpected(*broken_);
  }
  if (!accounted_) {
    return tl::unexpected(
        AuditBreak{anchor_ ? anchor_->number : 0,
                   "and those before it are missing: no record says that they were retired"});
  }
  if (!noted_found_) {
    return tl::unexpected(AuditBreak{
        chain_.head().number + 1,
        "is missing, or an earlier one was written anew: the chain is sound up to "
        "record " +
            std::to_string(chain_.head().number) + ", but none of its records has the hash " + *noted_});
  }
  return chain_.head();
}

}  // namespace interlock
