/**
 * @file
 * The check of the audit in parts, so that a long audit keeps nobody else from the store: the chain, the
 * heads that were noted elsewhere, and the users, whose every change the audit records.
 */
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "store/audit_chain.hpp"
#include "store/noted_heads.hpp"
#include "store/sqlite_forward.hpp"

namespace interlock {

/** A record after which heads that were noted before may be missing. */
struct ExcusingRecord {
  std::int64_t number = 0;
  std::string kind;   /**< restore or retention */
  std::string action; /**< of a restore: "store" or "new store" */
  std::string time;
  std::string actor;
  std::string os_user; /**< of the system; may be empty */
};

/** Noted heads that were not compared with the audit. */
struct HeadExcuse {
  std::size_t heads = 0;
  ExcusingRecord record;
  std::string doubt; /**< why the noted heads do not prove the record; empty: they do */
};

/** What became of the noted heads. */
struct HeadComparison {
  std::size_t compared = 0; /**< heads that are in the audit */
  std::int64_t up_to = 0;   /**< number of the last of them */
  std::vector<HeadExcuse> excuses;
};

/**
 * Follows the chain from its anchor to its last record. Between two parts records may be appended, and are
 * checked too; when old ones were retired meanwhile, the check begins anew behind the new anchor.
 */
class AuditCheck {
 public:
  /**
   * @param noted hash that the chain must contain, 64 hex digits; see `Audit::verify`
   * @param heads that the recorder noted: each must be in the chain, unless a record says that a restored or
   * new store took the place of the one that it belongs to
   */
  explicit AuditCheck(std::optional<std::string> noted = std::nullopt, NotedHeads heads = {});

  /**
   * Follows at most `count` further records.
   *
   * @return whether more are to be followed; false once the chain was followed to its end or is broken
   * @throws SQLite::Exception
   */
  bool go_on(SQLite::Database& database, std::size_t count);

  /** The head, or the first place where the chain is broken: of all records, once `go_on` has given false. */
  [[nodiscard]] tl::expected<AuditHead, AuditBreak> result() const;

  /** What `result`, where it is a head, says of the noted heads. */
  [[nodiscard]] const HeadComparison& comparison() const { return comparison_; }

 private:
  /** A record that says that another store took the place of the one that was there. */
  struct Replacement {
    ExcusingRecord record;
    std::optional<AuditHead> replaced; /**< where the other one ended, if that could be read */
  };

  void begin(const AuditHead& anchor);
  void take_in(const AuditRecord& record);
  [[nodiscard]] std::optional<AuditBreak> compare_users(SQLite::Database& database) const;
  std::optional<AuditBreak> compare_heads();
  [[nodiscard]] AuditBreak first_missing(const NotedHeads& missing) const;
  bool excuse_replaced(const NotedHeads& missing, std::int64_t until);
  void excuse(const NotedHeads& heads, const ExcusingRecord& record);
  void doubt_excuses_not_noted();

  std::optional<std::string> noted_;
  NotedHeads heads_;
  std::map<std::int64_t, std::string>
      hashes_; /**< of the records whose numbers were noted; empty: not seen */
  std::vector<Replacement> replacements_;
  std::map<std::string, std::string> users_; /**< digests by name; empty: of a release that had none */
  std::optional<AuditHead> anchor_;          /**< nothing before the first part */
  AuditChain chain_;
  std::optional<AuditBreak> broken_;
  HeadComparison comparison_;
  ExcusingRecord retention_; /**< says that those up to the anchor were retired, if `accounted_` */
  bool accounted_ = false;   /**< a record says that those up to the anchor were retired */
  bool noted_found_ = false;
};

}  // namespace interlock
