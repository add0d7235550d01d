/**
 * @file
 * What `interlock audit verify` reports of a chain without a break: how many noted heads it compared, and
 * which it did not compare because a record excuses them.
 */
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "store/audit_check.hpp"

namespace interlock::cli {

/** The noted heads and what became of them. */
struct ComparedHeads {
  std::filesystem::path file;
  std::size_t noted = 0;
  HeadComparison comparison;
  bool same_owner = true; /**< the store's owner can change the file, too */
};

/** What `audit verify` found. */
struct AuditVerdict {
  AuditHead head;
  std::optional<ComparedHeads> heads; /**< nothing for exported records, which stand for themselves */
};

/** Whether each record that excuses heads is proven. */
bool is_proven(const AuditVerdict& verdict);

/** One line; the hash of the head stands at its end. */
std::string text_of(const AuditVerdict& verdict);

nlohmann::json to_json(const AuditVerdict& verdict);

}  // namespace interlock::cli
