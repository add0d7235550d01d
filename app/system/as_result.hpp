/**
 * @file
 * How the app waits for the network: the error comes back as a value beside the result.
 */
#pragma once

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/use_awaitable.hpp>

namespace interlock {

inline constexpr auto as_result = boost::asio::as_tuple(boost::asio::use_awaitable);

}  // namespace interlock
