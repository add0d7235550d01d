/**
 * @file
 * HTTP messages of this server, and the two things a handler can answer with: success or a problem.
 */
#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/beast/http.hpp>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

namespace interlock::web {

/** A request as it came. */
using Request = boost::beast::http::request<boost::beast::http::string_body>;
/** An answer as it goes. */
using Response = boost::beast::http::response<boost::beast::http::string_body>;
/** A status code of HTTP. */
using Status = boost::beast::http::status;

/** Names and values. */
using Headers = std::vector<std::pair<std::string, std::string>>;

/** Schema `Problem` of spec/openapi.yaml. Empty texts are left out. */
struct Problem {
  Status status = Status::internal_server_error;
  std::string code = {};      /**< verdict name or a code of the interface */
  std::string detail = {};    /**< what, where */
  std::string field = {};     /**< the field of the body that is wrong */
  std::uint32_t line = 0;     /**< of a text, from 1; 0: none, or all of it */
  std::string expected = {};  /**< what belongs there instead */
  std::string next_step = {}; /**< what to do about it */
  Headers headers = {};       /**< besides those that every answer has */
};

/** An answer that is no problem. */
struct Success {
  Status status = Status::ok;
  nlohmann::json body = {};
  Headers headers = {};       /**< besides those that every answer has */
  std::string text_type = {}; /**< media type of a body that is one text and no JSON; empty: JSON */
};

/** What a route answers. */
using Reply = tl::expected<Success, Problem>;

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
 * separator or an end by decoding.
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

}  // namespace interlock::web
