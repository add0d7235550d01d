/**
 * @file
 * How registration, entry, target and probe change, whoever changes them and by whichever way.
 */
#pragma once

#include <nlohmann/json.hpp>

#include "http/context.hpp"
#include "http/targeting.hpp"

namespace interlock::web {

/** What a body makes of the values before: one of `with_registration` and its kind (targeting.hpp). */
using TargetingChange = tl::expected<Targeting, Problem> (*)(Targeting, const nlohmann::json&);

/**
 * Stores and audits what the body changes, with the way by which it came, and ends every proposal that
 * followed from other values. Nothing changes when the body is wrong (its problem), when the caller has lost
 * session (401 LOGIN) or authority (409 AUTHORITY) meanwhile, or the store fails (503 STORE).
 */
boost::asio::awaitable<tl::expected<Targeting, Problem>> change_targeting(const Context& context,
                                                                          Caller caller, TaskSource source,
                                                                          TargetingChange make,
                                                                          nlohmann::json body);

}  // namespace interlock::web
