/**
 * @file
 * Which handler answers which method and path, and who may call it. Rights are checked here and nowhere else.
 */
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "http/message.hpp"
#include "service/reply.hpp"

namespace interlock::web {

/** Values of the `{name}` segments of a route, in their order. */
using Parameters = std::vector<std::string>;

/** One request on its way to its handler, which has the right to be called. */
struct Call {
  const Request& request;
  const Parameters& parameters;
  const Caller& caller;
};

/** What answers a call. */
using Handler = std::function<boost::asio::awaitable<Reply>(const Call&)>;

/** Finds the route of a request and checks who may use it. */
class Router {
 public:
  /** Nothing when that caller is in control, else 409 CONTROL naming who is. */
  using NeedControl = std::function<std::optional<Problem>(const Caller&)>;

  explicit Router(NeedControl need_control) : need_control_(std::move(need_control)) {}

  /** `pattern` as in spec/openapi.yaml: "/api/motors/{axis}". Of patterns that a path matches, the one that
   * was added first has it alone. */
  void add(boost::beast::http::verb method, std::string_view pattern, Access access, Handler handler);

  /** Nothing when the caller has that right, else 401 LOGIN, 403 ROLE or 409 CONTROL. */
  [[nodiscard]] std::optional<Problem> check(const Access& access, const Caller& caller) const;

  /**
   * Runs the handler of the request. Refused before, in this order: 404 NOT_FOUND when no route has the path,
   * 405 METHOD_NOT_ALLOWED when one has, but not this method, 401 LOGIN when nobody is logged in, 403 ROLE,
   * 409 CONTROL. Request, caller and router must outlive the returned operation.
   */
  [[nodiscard]] boost::asio::awaitable<Reply> route(const Request& request, const Caller& caller) const;

 private:
  struct Route {
    boost::beast::http::verb method;
    std::vector<std::string> segments;
    Access access;
    Handler handler;
  };

  NeedControl need_control_;
  std::vector<Route> routes_;
};

}  // namespace interlock::web
