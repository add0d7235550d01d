/**
 * @file
 * The audit: who did what, and what came of it. Records are only ever appended, each sealed with the hash of
 * all before it (audit_chain.hpp).
 */
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "store/audit_chain.hpp"
#include "store/store.hpp"

namespace interlock {

/** What a record tells of. */
enum class AuditKind {
  start,
  login,
  login_refused,
  logout,
  session_ended,
  user,
  control,
  proposal,
  request,
  verdict,
  stop,
  setting,
  restore,
  bench,
  connection,
  records_lost,
  retention,
  acknowledgement,
  case_step,
  alarm
};

/** The name in spec/openapi.yaml: "login_refused". */
std::string_view audit_kind_name(AuditKind kind);

/** Actors that are no users; no user's name can be one of them but "kernel", "app" and "nobody". */
namespace audit_actor {
constexpr const char* kernel = "kernel";
constexpr const char* app = "app";
constexpr const char* command_line = "command line";
constexpr const char* nobody = "nobody";
}  // namespace audit_actor

/** What is to be recorded. */
struct AuditEntry {
  UtcTime time;
  std::optional<std::uint64_t> tick; /**< of the kernel, if there is one */
  std::string actor;                 /**< user, or one of `audit_actor` */
  std::optional<std::uint32_t> session;
  AuditKind kind = AuditKind::start;
  nlohmann::json detail = nlohmann::json::object(); /**< an object; no secrets */
};

/** Which records a list has; what is empty lets every one through. */
struct AuditFilter {
  std::optional<std::int64_t> before = {}; /**< only those of a smaller number */
  std::optional<std::string> kind = {};    /**< as `audit_kind_name` has it */
  std::optional<std::string> actor = {};
  std::optional<std::string> text = {}; /**< that stands in the detail, in capitals or not */
  std::optional<UtcTime> since = {};    /**< only those of then or later */
};

/** The audit in one transaction. */
class Audit {
 public:
  explicit Audit(Transaction& transaction) : database_(transaction.database()) {}

  /** Appends a record to the chain. It counts once the transaction is committed. One of a user gets the
   * user's digest, which `verify` compares; one of the command line the system's user. */
  AuditRecord append(const AuditEntry& entry);

  /** The newest `count` records that the filter lets through; oldest first. */
  [[nodiscard]] std::vector<AuditRecord> list(std::size_t count, const AuditFilter& filter = {}) const;

  /** The newest `count` records of those kinds with numbers from `first` to `last`; oldest first. */
  [[nodiscard]] std::vector<AuditRecord> between(std::int64_t first, std::int64_t last,
                                                 std::initializer_list<AuditKind> kinds,
                                                 std::size_t count) const;

  /** The number of the newest kept record of that kind; 0 when there is none. */
  [[nodiscard]] std::int64_t newest_of(AuditKind kind) const;

  /** The last record's number and hash. */
  [[nodiscard]] AuditHead head() const;

  /** The records before all those of the last `days` days on which anything was recorded; oldest first. Days
   * without a record do not count: a clock that jumped forwards makes nothing old. */
  [[nodiscard]] std::vector<AuditRecord> before_last_days(int days) const;

  /** Behind which the first kept record stands: zeros until records were retired. */
  [[nodiscard]] AuditHead anchor() const;

  /**
   * Removes the records up to `last`, one of those that are kept. The record that accounts for it is appended
   * with `entry`'s detail and the anchor; `verify` wants that record.
   */
  AuditRecord retire(const AuditHead& last, AuditEntry entry);

  /**
   * Goes over the whole chain and returns its head, or the first place where it is broken.
   *
   * Records that were cut off at the end leave no break: that shows only against a hash which was noted
   * before, and which the chain must still contain (`noted`, 64 hex digits).
   */
  [[nodiscard]] tl::expected<AuditHead, AuditBreak> verify(
      const std::optional<std::string>& noted = std::nullopt) const;

 private:
  SQLite::Database& database_;
};

}  // namespace interlock
