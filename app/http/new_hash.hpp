/**
 * @file
 * The hash of a password that somebody wishes to have.
 */
#pragma once

#include <string>

#include "http/work_pool.hpp"
#include "store/password.hpp"

namespace interlock::web {

/** 422 INVALID, naming `field`, when the user may not have that password; 503 OVERLOADED. */
boost::asio::awaitable<tl::expected<PasswordHash, Problem>> new_hash(WorkPool& pool, std::string user,
                                                                     Password password, std::string field);

}  // namespace interlock::web
