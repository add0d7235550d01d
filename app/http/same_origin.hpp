/**
 * @file
 * Keeps other sites' pages out: a browser on this machine may reach the loopback interface on their behalf.
 */
#pragma once

#include <optional>
#include <string>

#include "http/message.hpp"

namespace interlock::web {

/** A proxy with TLS on this machine, by which browsers on other machines reach the server. */
struct ReverseProxy {
  std::string origin;  /**< of pages that come by it, such as `https://robot.example`; empty: no proxy */
  std::string address; /**< connects from here; the client that it names is believed. Empty: never */
};

/** What is wrong with it, as options of a command line; nothing when it can be used. */
std::optional<std::string> problem_of(const ReverseProxy& proxy);

/** 403 HOST unless the request names this machine's loopback interface or the public name, as a rebound name
 * would not; 400 MALFORMED when it names two hosts, or none in HTTP/1.1. */
std::optional<Problem> check_host(const Request& request, const ReverseProxy& proxy);

/** 403 ORIGIN when the request was sent by a page of another origin. Requests that no page sent carry no
 * origin. */
std::optional<Problem> check_origin(const Request& request, const ReverseProxy& proxy);

/** Who sent the request: the peer of its connection, `address:port`; when that is the proxy, whom the last
 * X-Forwarded-For names, before the port of the proxy's connection. */
std::string client_of(const Request& request, const std::string& peer, const ReverseProxy& proxy);

/**
 * Name of the cookie that is the session: `interlock_session_8080`, with the port that the browser came to.
 * Cookies know no ports, so that two robots on one machine would else log each other out.
 */
std::string session_cookie(const Request& request);

/** Whether the method only reads. */
bool is_safe(boost::beast::http::verb method);

}  // namespace interlock::web
