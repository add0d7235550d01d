/**
 * @file
 * What the check of an audit whose chain has no break reports, on the command line and over HTTP: how many
 * noted heads it compared, and which it did not compare because a record excuses them.
 */
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "store/audit_check.hpp"
#include "store/store.hpp"

namespace interlock {

/** The noted heads and what became of them. */
struct ComparedHeads {
  std::filesystem::path file; /**< empty: this machine notes none */
  std::size_t noted = 0;
  HeadComparison comparison;
  bool same_owner = true; /**< the store's owner can change the file, too */
};

/** What the check found. */
struct AuditVerdict {
  AuditHead head;
  std::optional<ComparedHeads> heads; /**< nothing for exported records, which stand for themselves */
};

/** Checks the next 2,000 records, some ten milliseconds in which nobody else has the store; after the last
 * record of a sound chain the definitions of the store, too.
 *
 * @return whether more are to be checked */
Stored<bool> check_part(Store& store, AuditCheck& check);

/** Of a check that has ended, of the store in `store`, against `noted` heads of `file`. */
ComparedHeads compared_heads(const AuditCheck& check, std::filesystem::path file, std::size_t noted,
                             const std::filesystem::path& store);

/** Whether each record that excuses heads is proven. */
bool is_proven(const AuditVerdict& verdict);

/** One line; the hash of the head stands at its end. */
std::string text_of(const AuditVerdict& verdict);

/** Schema `AuditCheck` of spec/openapi.yaml has the noted heads alike. */
nlohmann::json to_json(const AuditVerdict& verdict);

}  // namespace interlock
