/**
 * @file
 * The hash of a password that somebody wants to have.
 */
#pragma once

#include <string>

#include "service/work_pool.hpp"
#include "store/password.hpp"

namespace interlock {

/** 422 INVALID, naming `field`, when the user may not have that password; 503 OVERLOADED. */
boost::asio::awaitable<tl::expected<PasswordHash, Problem>> new_hash(WorkPool& pool, std::string user,
                                                                     Password password, std::string field);

}  // namespace interlock
