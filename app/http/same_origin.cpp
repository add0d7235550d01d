#include "http/same_origin.hpp"

#include <algorithm>
#include <string_view>

namespace interlock::web {
namespace {

namespace http = boost::beast::http;

constexpr std::uint32_t default_port = 80;

std::string_view value_of(const Request& request, http::field field) {
  const auto value = request[field];
  return {value.data(), value.size()};
}

/** Where the colon before the port stands, or the end. */
std::size_t end_of_name(std::string_view host) {
  const std::size_t bracket = host.rfind(']');
  const std::size_t colon = host.rfind(':');
  const bool has_port =
      colon != std::string_view::npos && (bracket == std::string_view::npos || colon > bracket);
  return has_port ? colon : host.size();
}

std::string_view without_port(std::string_view host) { return host.substr(0, end_of_name(host)); }

}  // namespace

std::optional<Problem> check_host(const Request& request) {
  const std::size_t hosts = request.count(http::field::host);
  if (hosts > 1 || (hosts == 0 && request.version() >= 11)) {
    return Problem{.status = Status::bad_request,
                   .code = "MALFORMED",
                   .detail = "The request has " + std::to_string(hosts) + " Host headers.",
                   .expected = "one"};
  }
  const std::string_view host = without_port(value_of(request, http::field::host));
  if (host == "localhost" || host == "127.0.0.1" || host == "[::1]") {
    return std::nullopt;
  }
  return Problem{.status = Status::forbidden,
                 .code = "HOST",
                 .detail = "The host \"" + std::string(host) + "\" is not this machine.",
                 .expected = "localhost, 127.0.0.1 or [::1]",
                 .next_step = "Open the address that interlock-app printed."};
}

std::optional<Problem> check_origin(const Request& request) {
  const std::string_view origin = value_of(request, http::field::origin);
  const std::string own = "http://" + std::string(value_of(request, http::field::host));
  if (origin.empty() || origin == own) {
    return std::nullopt;
  }
  return Problem{.status = Status::forbidden,
                 .code = "ORIGIN",
                 .detail = "The page of \"" + std::string(origin) + "\" may not do this.",
                 .expected = own,
                 .next_step = "Use the console that this server brings."};
}

std::string session_cookie(const Request& request) {
  const std::string_view host = value_of(request, http::field::host);
  const auto port = number_in(host.substr(std::min(end_of_name(host) + 1, host.size())));
  return "interlock_session_" + std::to_string(port.value_or(default_port));
}

bool is_safe(http::verb method) { return method == http::verb::get || method == http::verb::head; }

}  // namespace interlock::web
