/**
 * @file
 * Heads of the audit that were noted outside of the app's reach. The app reports the head; the recorder,
 * which is another user, appends it to a file of its own: a line "TIME NUMBER HASH".
 */
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "store/audit_chain.hpp"
#include "store/store_error.hpp"

namespace interlock {

/** Name of the file among the recordings. */
constexpr const char* noted_heads_file_name = "audit-heads";

/** A head of the audit as the recorder noted it. */
struct NotedHead {
  std::string time; /**< of the recorder's clock */
  AuditHead head;
};

/** Oldest first. */
using NotedHeads = std::vector<NotedHead>;

/** The heads in that file; none when it is missing. A line that was cut off by a loss of power is left out.
 * Refused, unavailable: it cannot be read. */
Stored<NotedHeads> read_noted_heads(const std::filesystem::path& file);

/** Appends the head to the file that the recorder writes while a robot runs. False: there is none, or it
 * cannot be written by this user. */
bool note_head(const std::filesystem::path& file, const NotedHead& noted);

/** Reports the head to the recorder, and waits for nobody. False: no recorder takes it now. */
bool report_head(const std::filesystem::path& socket, const AuditHead& head);

}  // namespace interlock
