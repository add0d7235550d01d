/**
 * @file
 * Where the values of `Targeting` are kept: a setting of the store, audited.
 */
#pragma once

#include "http/context.hpp"
#include "http/targeting.hpp"
#include "store/settings.hpp"

namespace interlock::web {

/** The stored values; what the robot's file says until somebody sets others. */
Stored<Targeting> find_targeting(Transaction& transaction, const Robot& robot);

/** Stores the values and records in the audit what differs. */
void set_targeting(Transaction& transaction, const Targeting& before, const Targeting& after,
                   AuditEntry entry);

/** The present values, read outside of the network thread. */
boost::asio::awaitable<tl::expected<Targeting, Problem>> present_targeting(const Context& context);

}  // namespace interlock::web
