/**
 * @file
 * Which handler answers which method and path.
 */
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "http/message.hpp"

namespace interlock::web {

/** Values of the `{name}` segments of a route, in their order. */
using Parameters = std::vector<std::string>;
using Handler = std::function<boost::asio::awaitable<Reply>(const Request&, const Parameters&)>;

class Router {
 public:
  /** `pattern` as in spec/openapi.yaml: "/api/motors/{slot}". */
  void add(boost::beast::http::verb method, std::string_view pattern, Handler handler);

  /**
   * Runs the handler of the request. 404 NOT_FOUND when no route has the path, 405 METHOD_NOT_ALLOWED when
   * one has, but not this method. Request and router must outlive the returned operation.
   */
  [[nodiscard]] boost::asio::awaitable<Reply> route(const Request& request) const;

 private:
  struct Route {
    boost::beast::http::verb method;
    std::vector<std::string> segments;
    Handler handler;
  };

  std::vector<Route> routes_;
};

}  // namespace interlock::web
