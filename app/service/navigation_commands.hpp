/**
 * @file
 * Carries out what navigation programs request: as a setting or as a proposal, by the same ways as the
 * console's requests, under the same rules.
 */
#pragma once

#include <boost/asio/awaitable.hpp>
#include <optional>
#include <string>

#include "igtl/dialect.hpp"
#include "service/context.hpp"

namespace interlock {

/** What a navigation program is told of a problem. */
igtl::Status status_of(const Problem& problem);

/** Carries out a command that came under the name `device`, on behalf of the caller; audited. */
boost::asio::awaitable<igtl::Outcome> carry_out(const Context& context, const Caller& caller,
                                                std::string device, igtl::Command command);

/** What became of a STOP, once the kernel answered; 13 when none did. `cuts_power`: every axis is disabled
 * then. */
boost::asio::awaitable<igtl::Outcome> stopped(const Context& context,
                                              boost::asio::awaitable<std::optional<StopAnswer>> answered,
                                              bool cuts_power);

}  // namespace interlock
