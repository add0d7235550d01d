/**
 * @file
 * From a draft that somebody may propose to a proposal in the book.
 */
#pragma once

#include <variant>

#include "http/context.hpp"

namespace interlock::web {

using Draft = std::variant<MoveDraft, HomeDraft, PathDraft, SweepDraft, BiopsyDraft>;

/**
 * Records the draft in the audit, then proposes it. Nothing is proposed when that fails (503 STORE), when the
 * caller lost session or authority meanwhile (401 LOGIN, 409 AUTHORITY), when STOP was pressed meanwhile
 * (409 STOPPED), without a kernel (503 NO_KERNEL), or when the book refuses (its refusal).
 */
boost::asio::awaitable<tl::expected<Proposal, Problem>> propose(const Context& context, const Caller& caller,
                                                                Draft draft);

}  // namespace interlock::web
