/**
 * @file
 * From a task that somebody wants to a proposal in the book.
 */
#pragma once

#include "http/context.hpp"

namespace interlock::web {

/**
 * Records the task in the audit, then proposes it. Nothing is proposed when that fails (503 STORE), when the
 * caller lost session or authority meanwhile (401 LOGIN, 409 AUTHORITY), when STOP was pressed meanwhile
 * (409 STOPPED), without a kernel or a present state of it (503 NO_KERNEL), or when the book refuses (its
 * refusal).
 */
boost::asio::awaitable<tl::expected<Proposal, Problem>> propose(const Context& context, const Caller& caller,
                                                                Task task);

}  // namespace interlock::web
