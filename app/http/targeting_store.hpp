/**
 * @file
 * Where the values of `Targeting` are kept: a setting of the store, audited.
 */
#pragma once

#include "http/alignment_view.hpp"
#include "http/context.hpp"
#include "http/targeting.hpp"
#include "store/settings.hpp"

namespace interlock::web {

/** The stored values; what the robot's file says until somebody sets others. */
Stored<Targeting> find_targeting(Transaction& transaction, const Robot& robot);

/** By which way a change of the targeting came. */
struct TargetingOrigin {
  TaskSource source = TaskSource::console; /**< as of a proposal */
  std::string client;                      /**< as `Caller::peer` */
};

/** Stores the values, records in the audit what differs, and notes it in the targeting's history. */
void set_targeting(Transaction& transaction, const Targeting& before, const Targeting& after,
                   const TargetingOrigin& origin, AuditEntry entry);

/** As `alignment_with`, outside of the network thread: a search for the positions of a chain of joints takes
 * a tenth of a second. Also 503 OVERLOADED of the pool. */
boost::asio::awaitable<tl::expected<Alignment, Problem>> aligned(const Context& context,
                                                                 const Targeting& targeting);

/** The present values, read outside of the network thread. */
boost::asio::awaitable<tl::expected<Targeting, Problem>> present_targeting(const Context& context);

}  // namespace interlock::web
