#include "store/audit_check.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <nlohmann/json.hpp>

#include "store/audit_table.hpp"
#include "store/user_row.hpp"
#include "system/utc_time.hpp"

namespace interlock {
namespace {

using nlohmann::json;

/** What stands there; null for nothing, also in a record that was forged. */
json at(const json& detail, const char* key) {
  return detail.is_object() ? detail.value(key, json()) : json();
}

std::string text_at(const json& detail, const char* key) {
  const json text = at(detail, key);
  return text.is_string() ? text.get<std::string>() : "";
}

std::optional<AuditHead> head_in(const json& head) {
  const json number = at(head, "number");
  return number.is_number_integer()
             ? std::optional(AuditHead{number.get<std::int64_t>(), text_at(head, "hash")})
             : std::nullopt;
}

ExcusingRecord excusing(const AuditRecord& record, const json& detail) {
  return {record.number, record.kind,  text_at(detail, "action"),
          record.time,   record.actor, text_at(detail, "os_user")};
}

/** The app reports a head within a second, and the recorder appends it within ten more. */
constexpr std::chrono::seconds longest_until_noted{30};

}  // namespace

AuditCheck::AuditCheck(std::optional<std::string> noted, NotedHeads heads)
    : noted_(std::move(noted)), heads_(std::move(heads)) {}

void AuditCheck::begin(const AuditHead& anchor) {
  anchor_ = anchor;
  chain_ = AuditChain(anchor);
  accounted_ = anchor == AuditHead{};
  noted_found_ = !noted_ || *noted_ == anchor.hash;
  hashes_.clear();
  for (const NotedHead& noted : heads_) {
    hashes_[noted.head.number] = noted.head.number == anchor.number ? anchor.hash : "";
  }
  replacements_.clear();
  comparison_ = {};
  retention_ = {};
  users_.clear();
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
    take_in(record);
  }
  if (followed == count) {
    return true;
  }
  broken_ = compare_heads();
  if (!broken_) {
    broken_ = compare_users(database);
  }
  return false;
}

/** What a record says of other records, of the store or of a user. */
void AuditCheck::take_in(const AuditRecord& record) {
  noted_found_ = noted_found_ || *noted_ == record.hash;
  if (const auto noted = hashes_.find(record.number); noted != hashes_.end()) {
    noted->second = record.hash;
  }
  if (record.kind != "retention" && record.kind != "restore" && record.kind != "user") {
    return;
  }
  const json detail = json::parse(record.detail, nullptr, false);
  if (record.kind == "user") {
    users_[text_at(detail, "name")] = text_at(detail, "digest");
  } else if (record.kind == "restore") {
    const std::string action = text_at(detail, "action");
    if (action == "store" || action == "new store") {
      replacements_.push_back({excusing(record, detail), head_in(at(detail, "replaced_head"))});
    }
  } else if (at(detail, "removed_to") == anchor_->number && at(detail, "hash") == anchor_->hash) {
    accounted_ = true;
    retention_ = excusing(record, detail);
    // What the removed records said of the users, unless those that were kept say something newer.
    const json users = at(detail, "users");
    for (const auto& [name, digest] : users.items()) {
      users_.emplace(name, digest.is_string() ? digest.get<std::string>() : "");
    }
  }
}

/** As the audit has them; a store whose audit has no digests yet was made by an older release. */
std::optional<AuditBreak> AuditCheck::compare_users(SQLite::Database& database) const {
  if (std::ranges::all_of(users_, [](const auto& user) { return user.second.empty(); })) {
    return std::nullopt;
  }
  const std::map<std::string, std::string> present = user_digests(database);
  const auto differs = [&](const std::string& name, const std::string& problem) {
    return AuditBreak{chain_.head().number, "is the last one, but user " + name + ' ' + problem +
                                                ": somebody changed the table of users past Interlock"};
  };
  for (const auto& [name, digest] : present) {
    const auto recorded = users_.find(name);
    if (recorded == users_.end()) {
      return differs(name, "was added without a record");
    }
    if (!recorded->second.empty() && recorded->second != digest) {
      return differs(name, "has another role, password or state than the audit says");
    }
  }
  for (const auto& [name, digest] : users_) {
    if (!digest.empty() && !present.contains(name)) {
      return differs(name, "is missing");
    }
  }
  return std::nullopt;
}

AuditBreak AuditCheck::first_missing(const NotedHeads& missing) const {
  const NotedHead& first = missing.front();
  const bool cut = first.head.number > chain_.head().number;
  return {first.head.number,
          (cut ? "is missing: the audit ends at record " + std::to_string(chain_.head().number) +
                     ", but the recorder noted it"
               : std::string("is not the one that the recorder noted")) +
              " at " + first.time + " as " + first.head.hash +
              (cut ? "; records were cut off, or an older copy of the store was put in place"
                   : "; it or one before it was written anew, or another store was put in place")};
}

/** In the order in which they were noted, each must be in the chain. Those before one that has been retired
 * since are left to the files of the retired records. */
std::optional<AuditBreak> AuditCheck::compare_heads() {
  NotedHeads missing;
  NotedHeads retired;
  for (const NotedHead& noted : heads_) {
    if (noted.head.number < anchor_->number) {
      retired.insert(retired.end(), missing.begin(), missing.end());
      retired.push_back(noted);
      missing.clear();
    } else if (hashes_.at(noted.head.number) != noted.head.hash) {
      missing.push_back(noted);
    } else {
      if (!missing.empty() && !excuse_replaced(missing, noted.head.number)) {
        return first_missing(missing);
      }
      missing.clear();
      ++comparison_.compared;
      comparison_.up_to = noted.head.number;
    }
  }
  if (!missing.empty() && !excuse_replaced(missing, chain_.head().number)) {
    return first_missing(missing);
  }
  if (!retired.empty()) {
    excuse(retired, retention_);
  }
  doubt_excuses_not_noted();
  return std::nullopt;
}

/** Whether heads that follow one another belong to a store in whose place another one was put: by a record of
 * that, after the last head that was found and not after `until`, which knows of them all.
 *
 * The store of the last head that was found went on to the first missing ones, so the record cannot come
 * after one of them. From the first one with a lower number on they belong to a store that began anew in
 * between. */
bool AuditCheck::excuse_replaced(const NotedHeads& missing, std::int64_t until) {
  const std::int64_t after = comparison_.up_to;
  const std::int64_t first = missing.front().head.number;
  const std::int64_t lowest = first > after ? first : std::numeric_limits<std::int64_t>::max();
  const AuditHead& last = missing.back().head;
  const auto replacement = std::ranges::find_if(replacements_, [&](const Replacement& each) {
    const std::int64_t number = each.record.number;
    const bool in_between = number > after && number <= until && number <= lowest;
    return in_between && (!each.replaced || each.replaced->number > last.number || *each.replaced == last);
  });
  if (replacement == replacements_.end()) {
    return false;
  }
  excuse(missing, replacement->record);
  return true;
}

void AuditCheck::excuse(const NotedHeads& heads, const ExcusingRecord& record) {
  HeadExcuse excuse{heads.size(), record, ""};
  const auto recorded = parse_iso_8601(record.time);
  for (const NotedHead& noted : heads) {
    const auto time = parse_iso_8601(noted.time);
    if (record.kind == "retention" && noted.head.number >= anchor_->number) {
      excuse.doubt = "it retired the records up to " + std::to_string(anchor_->number) + ", but record " +
                     std::to_string(noted.head.number) + " was noted, too";
    } else if (!recorded || (time && *time > *recorded + longest_until_noted)) {
      excuse.doubt = "head " + std::to_string(noted.head.number) + " was noted after it, at " + noted.time;
    }
  }
  comparison_.excuses.push_back(std::move(excuse));
}

/** Whoever can write the store can write a record that excuses heads; a head that was noted later shows that
 * it is no newer than that. */
void AuditCheck::doubt_excuses_not_noted() {
  for (HeadExcuse& excuse : comparison_.excuses) {
    if (excuse.record.number > comparison_.up_to) {
      excuse.doubt = "no head was noted since that contains it";
    }
  }
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
