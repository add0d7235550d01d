/**
 * @file
 * `interlock audit verify|list`.
 */
#pragma once

#include <cstddef>
#include <optional>
#include <ostream>
#include <string>

#include "cli/exit_code.hpp"
#include "cli/store_place.hpp"

namespace interlock::cli {

struct AuditOptions {
  StorePlace place;
  std::optional<std::string> expected_hash; /**< a head that was noted before */
  std::size_t records = 20;
  bool json = false;
};

/** Goes over the whole chain and shows its head; refused, with the place, where it is broken. */
Result<void> verify_audit(const AuditOptions& options, const Installation& installation,
                          std::ostream& output);

/** The newest records, oldest first. */
Result<void> list_audit(const AuditOptions& options, const Installation& installation, std::ostream& output);

}  // namespace interlock::cli
