/**
 * @file
 * The check of the audit's chain in parts, so that a long audit keeps nobody else from the store.
 */
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <utility>

#include "store/audit_chain.hpp"
#include "store/sqlite_forward.hpp"

namespace interlock {

/**
 * Follows the chain from its anchor to its last record. Between two parts records may be appended, and are
 * checked too; when old ones were retired meanwhile, the check begins anew behind the new anchor.
 */
class AuditCheck {
 public:
  /** @param noted hash that the chain must contain, 64 hex digits; see `Audit::verify` */
  explicit AuditCheck(std::optional<std::string> noted = std::nullopt) : noted_(std::move(noted)) {}

  /**
   * Follows at most `count` further records.
   *
   * @return whether more are to be followed; false once the chain was followed to its end or is broken
   * @throws SQLite::Exception
   */
  bool go_on(SQLite::Database& database, std::size_t count);

  /** The head, or the first place where the chain is broken: of all records, once `go_on` has given false. */
  [[nodiscard]] tl::expected<AuditHead, AuditBreak> result() const;

 private:
  void begin(const AuditHead& anchor);

  std::optional<std::string> noted_;
  std::optional<AuditHead> anchor_; /**< nothing before the first part */
  AuditChain chain_;
  std::optional<AuditBreak> broken_;
  bool accounted_ = false; /**< a record says that those up to the anchor were retired */
  bool noted_found_ = false;
};

}  // namespace interlock
