/**
 * @file
 * `interlock audit verify|list|export|retire`.
 */
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <ostream>
#include <string>

#include "cli/exit_code.hpp"
#include "cli/store_place.hpp"

namespace interlock::cli {

struct AuditOptions {
  StorePlace place;
  std::optional<std::string> expected_hash; /**< a head that was noted before */
  std::filesystem::path heads;              /**< that the recorder noted; empty: those of the state */
  std::size_t records = 20;
  bool json = false;
  std::filesystem::path file; /**< exported records: to verify, or to make */
  std::uint32_t keep_days = 0;
};

/** Goes over the whole chain, compares it with the heads that the recorder noted and with the users, and
 * shows its head; refused, with the place, where something differs, or where a record that excuses noted
 * heads is not proven. */
Result<void> verify_audit(const AuditOptions& options, const Installation& installation,
                          std::ostream& output);

/** Writes all records into a file, which verifies by itself. */
Result<void> export_audit(const AuditOptions& options, const Installation& installation,
                          std::ostream& output);

/** Moves the records older than `keep_days` into a file, and leaves a record of it. Refused where the chain
 * is broken. */
Result<void> retire_audit(const AuditOptions& options, const Installation& installation,
                          std::ostream& output);

/** The newest records, oldest first. */
Result<void> list_audit(const AuditOptions& options, const Installation& installation, std::ostream& output);

}  // namespace interlock::cli
