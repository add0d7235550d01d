/**
 * @file
 * HTTP messages of this server, and the two things a handler can answer with: success or a problem.
 */
#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/beast/http.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <tl/expected.hpp>

namespace interlock::web {

using Request = boost::beast::http::request<boost::beast::http::string_body>;
using Response = boost::beast::http::response<boost::beast::http::string_body>;
using Status = boost::beast::http::status;

/** Schema `Problem` of spec/openapi.yaml. Empty texts are left out. */
struct Problem {
  Status status = Status::internal_server_error;
  std::string code;      /**< verdict name or a code of the interface */
  std::string detail;    /**< what, where */
  std::string field;     /**< the field of the body that is wrong */
  std::string expected;  /**< what belongs there instead */
  std::string next_step; /**< what to do about it */
  std::string allow;     /**< methods of the header `Allow`, for METHOD_NOT_ALLOWED */
};

struct Success {
  Status status = Status::ok;
  nlohmann::json body;
};

using Reply = tl::expected<Success, Problem>;

/** Answer in JSON. */
Response json_response(const Success& success);

/** Answer in `application/problem+json`. */
Response problem_response(const Problem& problem);

/** The path of the request's target, without query and fragment, percent-decoded; empty when that is
 * malformed. */
std::string path_of(const Request& request);

/** The body as JSON; 400 MALFORMED when it is none. */
tl::expected<nlohmann::json, Problem> parse_body(const Request& request);

}  // namespace interlock::web
