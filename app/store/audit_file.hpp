/**
 * @file
 * Records of the audit in a file of their own: JSON, one object a line, which verifies without the store.
 */
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "store/audit_chain.hpp"
#include "store/store_error.hpp"

namespace interlock {

/** Writes the records behind `before` into a new file, which is on the disk when this returns. Refused,
 * exists: the file is there already. */
Stored<void> write_audit_file(const std::filesystem::path& file, const AuditHead& before,
                              const std::vector<AuditRecord>& records);

/** Where the records of such a file end; the first break. Refused, damaged: the file is none. */
Stored<tl::expected<AuditHead, AuditBreak>> verify_audit_file(const std::filesystem::path& file,
                                                              const std::optional<std::string>& noted);

}  // namespace interlock
