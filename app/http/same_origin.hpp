/**
 * @file
 * Keeps other sites' pages out: a browser on this machine may reach the loopback interface on their behalf.
 */
#pragma once

#include <optional>
#include <string>

#include "http/message.hpp"

namespace interlock::web {

/** 403 HOST unless the request names this machine's loopback interface, as a rebound name would not; 400
 * MALFORMED when it names two hosts, or none in HTTP/1.1. */
std::optional<Problem> check_host(const Request& request);

/** 403 ORIGIN when the request was sent by a page of another origin. Requests that no page sent carry no
 * origin. */
std::optional<Problem> check_origin(const Request& request);

/**
 * Name of the cookie that is the session: `interlock_session_8080`, with the port that the browser came to.
 * Cookies know no ports, so that two robots on one machine would else log each other out.
 */
std::string session_cookie(const Request& request);

/** Whether the method only reads. */
bool is_safe(boost::beast::http::verb method);

}  // namespace interlock::web
