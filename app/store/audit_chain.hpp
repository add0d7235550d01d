/**
 * @file
 * How the records of the audit are chained, without the database that keeps them.
 */
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace interlock {

/** One record as it is stored. */
struct AuditRecord {
  std::int64_t number = 0; /**< 1, 2, 3 ... */
  std::string time;        /**< UTC, ISO 8601 with milliseconds */
  std::optional<std::int64_t> tick;
  std::string actor;
  std::optional<std::int64_t> session;
  std::string kind;
  std::string detail; /**< JSON object, as it was hashed */
  std::string hash;   /**< SHA-256, 64 hex digits */

  bool operator==(const AuditRecord&) const = default;
};

/** Schema `AuditRecord` of spec/openapi.yaml. */
nlohmann::json to_json(const AuditRecord& record);

/** What the hash of a record is computed over (docs/store.md): each field as LENGTH:BYTES, and the last hash
 * first. */
std::string canonical_encoding(const AuditRecord& record, const std::string& previous_hash);

/** The hash that a record must have behind one with `previous_hash`. */
std::string audit_hash(const AuditRecord& record, const std::string& previous_hash);

/** Where a chain ends; of an empty one number 0 and 64 zeros. */
struct AuditHead {
  std::int64_t number = 0;
  std::string hash = std::string(64, '0');

  bool operator==(const AuditHead&) const = default;
};

/** Where a chain is broken first. */
struct AuditBreak {
  std::int64_t number = 0; /**< of the record that is not what it should be */
  std::string problem;     /**< what differs, for people */
};

/** Follows a chain, from its first record on or from a later one. */
class AuditChain {
 public:
  /** Behind which the first record to follow stands. */
  explicit AuditChain(AuditHead behind = {}) : head_(std::move(behind)) {}

  /** The next record; the break if it does not continue the chain. */
  tl::expected<void, AuditBreak> follow(const AuditRecord& record);

  [[nodiscard]] const AuditHead& head() const { return head_; }

 private:
  AuditHead head_;
};

}  // namespace interlock
