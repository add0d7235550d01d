#include "http/same_origin.hpp"

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <string_view>

namespace interlock::web {
namespace {

namespace http = boost::beast::http;

constexpr std::uint32_t default_port = 80;
constexpr std::string_view https = "https://";

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

bool is_public(std::string_view host, const ReverseProxy& proxy) {
  return !proxy.origin.empty() &&
         without_port(host) == without_port(std::string_view(proxy.origin).substr(https.size()));
}

/** An address as the name of a peer begins with it; empty when the text is none. */
std::string address_in(std::string_view text) {
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address(text, error);
  const std::string spelled = error ? std::string() : address.to_string();
  return !error && address.is_v6() ? "[" + spelled + "]" : spelled;
}

}  // namespace

std::optional<std::string> problem_of(const ReverseProxy& proxy) {
  const std::string_view origin = proxy.origin;
  if (!origin.empty() && (!origin.starts_with(https) || origin.size() == https.size() ||
                          origin.find_first_of("/?#@ ", https.size()) != std::string_view::npos)) {
    return "--public-origin " + proxy.origin +
           " is no origin with TLS; expected one such as https://robot.example";
  }
  if (!proxy.address.empty() && address_in(proxy.address).empty()) {
    return "--trusted-proxy " + proxy.address + " is no address; expected one such as 127.0.0.1";
  }
  return std::nullopt;
}

std::optional<Problem> check_host(const Request& request, const ReverseProxy& proxy) {
  const std::size_t hosts = request.count(http::field::host);
  if (hosts > 1 || (hosts == 0 && request.version() >= 11)) {
    return Problem{.status = Status::bad_request,
                   .code = "MALFORMED",
                   .detail = "The request has " + std::to_string(hosts) + " Host headers.",
                   .expected = "one"};
  }
  const std::string_view host = without_port(value_of(request, http::field::host));
  if (host == "localhost" || host == "127.0.0.1" || host == "[::1]" || is_public(host, proxy)) {
    return std::nullopt;
  }
  return Problem{.status = Status::forbidden,
                 .code = "HOST",
                 .detail = "The host \"" + std::string(host) + "\" is not this machine.",
                 .expected = "localhost, 127.0.0.1 or [::1]",
                 .next_step = "Open the address that interlock-app printed."};
}

std::optional<Problem> check_origin(const Request& request, const ReverseProxy& proxy) {
  const std::string_view origin = value_of(request, http::field::origin);
  const std::string_view host = value_of(request, http::field::host);
  const std::string own = is_public(host, proxy) ? proxy.origin : "http://" + std::string(host);
  if (origin.empty() || origin == own || origin == proxy.origin) {
    return std::nullopt;
  }
  return Problem{.status = Status::forbidden,
                 .code = "ORIGIN",
                 .detail = "The page of \"" + std::string(origin) + "\" may not do this.",
                 .expected = own,
                 .next_step = "Use the console that this server brings."};
}

std::string client_of(const Request& request, const std::string& peer, const ReverseProxy& proxy) {
  const std::size_t colon = std::min(peer.rfind(':'), peer.size());
  if (proxy.address.empty() || peer.substr(0, colon) != address_in(proxy.address)) {
    return peer;
  }
  std::string_view named;
  const auto [first, last] = request.equal_range("X-Forwarded-For");
  for (auto field = first; field != last; ++field) {
    named = {field->value().data(), field->value().size()};
  }
  named.remove_prefix(std::min(named.find_last_of(", ") + 1, named.size()));
  const std::string client = address_in(named);
  return client.empty() ? peer : client + peer.substr(colon);
}

std::string session_cookie(const Request& request) {
  const std::string_view host = value_of(request, http::field::host);
  const auto port = number_in(host.substr(std::min(end_of_name(host) + 1, host.size())));
  return "interlock_session_" + std::to_string(port.value_or(default_port));
}

bool is_safe(http::verb method) { return method == http::verb::get || method == http::verb::head; }

}  // namespace interlock::web
