/**
 * @file
 * Problems that several routes answer with.
 */
#pragma once

#include <string>

#include "http/access.hpp"
#include "http/message.hpp"
#include "proposals/move_check.hpp"

namespace interlock::web {

/** A reply, or any other expected value, that is this problem. */
inline tl::unexpected<Problem> fail(Problem problem) { return tl::make_unexpected(std::move(problem)); }

/** 404 NOT_FOUND. `expected` says where to find what there is. */
Problem not_found(const std::string& what, const std::string& expected);

/** 401 LOGIN. */
Problem login_needed();

/** Whether whoever asked then has given up since, so that nothing may come into force by it. */
bool has_waited_too_long(std::chrono::steady_clock::time_point asked);

/** 503 LATE: it waited for too long, or a STOP came after it. */
Problem too_late();

/** 503 NO_KERNEL. */
Problem no_kernel(const std::string& detail);

/** 409 STOPPED: STOP was pressed, or the motion authority changed, before `what` was sent. */
Problem stopped_meanwhile(const std::string& what);

/** What the kernel or the proposals' checks refused: 409, 404 for what the robot has not, or 503 when the
 * control thread takes no more. */
Problem refused(const Refusal& refusal);

}  // namespace interlock::web
