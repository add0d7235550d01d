/**
 * @file
 * HTTP messages of this server: what is read from a request, and how what the services answer becomes a
 * response.
 */
#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/beast/http.hpp>
#include <cstdint>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "service/reply.hpp"

namespace interlock::web {

// What JSON must not be, besides malformed, before anything is made of it.

/** Objects and arrays in one another. */
constexpr std::size_t deepest_json = 64;

/**
 * What is wrong with the shape of a JSON text: deeper than `deepest_json`, or a key twice in one object, of
 * which one reader would take the first and another the last. Nothing for a text that is no JSON at all.
 */
std::optional<std::string> flaw_of_json(std::string_view text);

// HTTP messages of this server, and how what the services answer becomes one.

/** A request as it came. */
using Request = boost::beast::http::request<boost::beast::http::string_body>;
/** An answer as it goes. */
using Response = boost::beast::http::response<boost::beast::http::string_body>;
/** That status, as Beast names it. */
constexpr boost::beast::http::status http_status(Status status) noexcept {
  return static_cast<boost::beast::http::status>(status);
}

/** Answer in JSON, or in the text that the body is. */
Response success_response(const Success& success);

/** Answer in `application/problem+json`. */
Response problem_response(const Problem& problem);

constexpr std::uint64_t longest_body = 64u * 1024u;
/** Of a trajectory that somebody uploads who may load one. */
constexpr std::uint64_t longest_trajectory = 16u * 1024u * 1024u;
constexpr std::uint32_t longest_header = 16u * 1024u;

/** Why that is no request of this interface, as the reader of it found; nothing when the connection ended. */
std::optional<Problem> unreadable(const boost::beast::error_code& error);

/**
 * Why the header leaves open where the request ends: 501 NOT_IMPLEMENTED for a Transfer-Encoding other than
 * `chunked` alone; 400 MALFORMED for one beside a Content-Length or in HTTP/1.0. The connection must then be
 * closed, since what follows the header may be a body or another request.
 */
std::optional<Problem> check_framing(const Request& header);

/** Adds the headers of every answer, which keep pages of other sites out. */
void secure(boost::beast::http::fields& head);

/** Makes an answer ready to be sent: length, version, and the headers that keep pages of other sites out. */
void prepare(Response& response, bool keep_alive);

/**
 * The path of the request's target, without query and fragment, percent-decoded; empty when that is
 * malformed. An encoded slash, backslash or NUL counts as malformed, so that no part of a path turns into a
 * separator or an end by decoding. A former name of a path gives the present one.
 */
std::string path_of(const Request& request);

/**
 * The query of the request's target as an object of texts, to be read with `Fields`: `?lines=5` is
 * `{"lines": "5"}`. 400 MALFORMED when its percent-encoding is wrong or a name comes twice.
 */
tl::expected<nlohmann::json, Problem> parse_query(const Request& request);

/** The different values of the cookies of that name, at most four. */
std::vector<std::string> cookies_of(const Request& request, std::string_view name);

/** The text as a whole decimal number; nothing when it is none. */
std::optional<std::uint32_t> number_in(std::string_view text);

/** The body as JSON; 400 MALFORMED when it is none, nests deeper than 64, or has a key twice in one object.
 */
tl::expected<nlohmann::json, Problem> parse_body(const Request& request);

// The query of a request, as far as a route knows it.

/** The known parameters of the query as an object of texts; unknown ones are ignored. 400 MALFORMED as of
 * `parse_query`. */
tl::expected<nlohmann::json, Problem> known_query(const Request& request,
                                                  std::initializer_list<const char*> known);

}  // namespace interlock::web
