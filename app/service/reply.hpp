/**
 * @file
 * Who asks, and the two things a service can answer with: success or a problem.
 */
#pragma once

#include <chrono>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "proposals/checks.hpp"
#include "store/users.hpp"

namespace interlock {

// Who calls, and who may: the right that each route asks for.

/** Who sent a request. */
struct Caller {
  std::uint32_t session = 0; /**< 0: nobody is logged in */
  std::string user;
  std::optional<Role> role;
  std::string peer;        /**< address and port that the request came from */
  bool is_program = false; /**< a navigation program, on behalf of the user who made it the controller */
  /** When it asked, no later than that. */
  std::chrono::steady_clock::time_point asked = std::chrono::steady_clock::now();
};

/** `x-role` and `x-control` of spec/openapi.yaml. */
struct Access {
  std::optional<Role> role; /**< the least that suffices; empty: anybody, even without login */
  bool control = false;     /**< only the session that is in control */
};

constexpr Access anybody{};
constexpr Access viewers{Role::viewer};
constexpr Access engineers{Role::engineer};
constexpr Access admins{Role::admin};
constexpr Access holder{Role::engineer, true};

// The two things a service can answer with: success or a problem.

/** How an answer ended, by the numbers of HTTP (RFC 9110), which every way to the services can translate. */
enum class Status : std::uint16_t {
  ok = 200,
  created = 201,
  accepted = 202,
  bad_request = 400,
  unauthorized = 401,
  forbidden = 403,
  not_found = 404,
  method_not_allowed = 405,
  conflict = 409,
  payload_too_large = 413,
  unprocessable_entity = 422,
  upgrade_required = 426,
  too_many_requests = 429,
  request_header_fields_too_large = 431,
  not_implemented = 501,
  service_unavailable = 503,
};

/** Names and values. */
using Headers = std::vector<std::pair<std::string, std::string>>;

/** Schema `Problem` of spec/openapi.yaml. Empty texts are left out. */
struct Problem {
  Status status = Status::service_unavailable;
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

// Problems that several routes answer with.

/** 409 CONTROL: whoever was in control when this was asked is no more. */
Problem control_lost();

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

/** 409 STOPPED: STOP was pressed, or control changed hands, before `what` was sent. */
Problem stopped_meanwhile(const std::string& what);

/** What the kernel or the proposals' checks refused: 409, 404 for what the robot has not, or 503 when the
 * control thread takes no more. */
Problem refused(const Refusal& refusal);

}  // namespace interlock
