/**
 * @file
 * What was set of the targeting, when, by whom and from where: schema `TargetingHistory` of
 * spec/openapi.yaml.
 *
 * The audit has all of it, for administrators and without end; this is its short form for whoever aims, kept
 * beside the values in the same transaction, so that nobody has to search the audit.
 */
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "store/audit.hpp"

namespace interlock::web {

/** Changes that are kept, the newest. */
constexpr std::size_t most_targeting_changes = 50;

/**
 * Notes the change that the audit's record `number` tells of: `old` and `new` in the entry's detail, by
 * field, with `source` and `client`. A change of the reported pose alone is noted as the field's last one and
 * not listed: an imager reports many times a second.
 */
void note_targeting_change(Transaction& transaction, const AuditEntry& entry, std::int64_t number);

/** Schema `TargetingHistory`, told at `now`. What cannot be read of it counts as never noted: the audit has
 * it. */
nlohmann::json targeting_history(Transaction& transaction, UtcTime now);

}  // namespace interlock::web
