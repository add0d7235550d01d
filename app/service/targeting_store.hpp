/**
 * @file
 * Registration, entry, target and probe offsets in the store: how they are read, changed and used.
 */
#pragma once

#include <nlohmann/json.hpp>

#include "service/alignment_view.hpp"
#include "service/context.hpp"
#include "service/targeting.hpp"
#include "store/audit.hpp"
#include "store/cases.hpp"

namespace interlock {

// Where the values of `Targeting` are kept: with their case, audited.

/** What the robot's file says; of no case. */
Targeting first_targeting(const Robot& robot);

/** Those of that case, not yet judged. */
Stored<Targeting> targeting_of(const KeptCase& kept);

/** Those of the case in hand, not yet judged; the first ones when none is. */
Stored<Targeting> find_targeting(Transaction& transaction, const Robot& robot);

/** By which way a change of the targeting came. */
struct TargetingOrigin {
  TaskSource source = TaskSource::console; /**< as of a proposal */
  std::string client;                      /**< as `Caller::peer` */
};

/** Stores the values with their case, records in the audit what differs, and notes it in the targeting's
 * history. */
void set_targeting(Transaction& transaction, const Targeting& before, const Targeting& after,
                   const TargetingOrigin& origin, AuditEntry entry);

/** Changes that a history lists, the newest. */
constexpr std::size_t most_targeting_changes = 50;

/** Schema `TargetingHistory` of spec/openapi.yaml, of the case in hand, told at `now`: what was set, when, by
 * whom and from where. The audit has all of it, for administrators; this is for whoever aims. */
nlohmann::json targeting_history(Transaction& transaction, UtcTime now);

/** As `alignment_with`, outside of the network thread: a search for the positions of a chain of joints takes
 * a tenth of a second. Also 503 OVERLOADED of the pool. */
boost::asio::awaitable<tl::expected<Alignment, Problem>> aligned(const Context& context,
                                                                 const Targeting& targeting);

/** The present values, read outside of the network thread, and judged. */
boost::asio::awaitable<tl::expected<Targeting, Problem>> present_targeting(const Context& context);

// How registration, entry, target and probe change, whoever changes them and by whichever way.

/** What a body makes of the values before: one of `with_registration` and its kind (targeting.hpp). */
using TargetingChange = tl::expected<Targeting, Problem> (*)(Targeting, const nlohmann::json&);

/**
 * Stores and audits what the body changes, with the way by which it came, and ends every proposal that
 * followed from other values. Nothing changes without an open case (409 NO_CASE), when the body is wrong (its
 * problem), when the caller has lost session (401 LOGIN) or control (409 CONTROL) meanwhile, or the store
 * fails (503 STORE). A registration that can hardly be right needs a reason (422 IMPLAUSIBLE), which
 * navigation programs cannot give. A program may not set the registration again that has expired (409
 * NO_REGISTRATION), nor an entry or target of before the table moved or of another case (409 NO_TARGET): only
 * a person can know that it holds.
 */
boost::asio::awaitable<tl::expected<Targeting, Problem>> change_targeting(const Context& context,
                                                                          Caller caller, TaskSource source,
                                                                          TargetingChange make,
                                                                          nlohmann::json body);

/** 409 NO_TARGET when a program may not set one of these points. */
boost::asio::awaitable<tl::expected<void, Problem>> check_points(const Context& context,
                                                                 std::vector<Point> points);

/** Ends the validity of the registration at once, with everything that followed from it, on behalf of the
 * caller or, without a session, of the app. The store keeps the reason; 503 STORE when it cannot: then
 * another start of the app tells another one. */
boost::asio::awaitable<tl::expected<Targeting, Problem>> expire_registration(const Context& context,
                                                                             Caller caller,
                                                                             std::string reason);

}  // namespace interlock
