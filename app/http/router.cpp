#include "http/router.hpp"

#include "service/reply.hpp"

namespace interlock::web {
namespace {

namespace http = boost::beast::http;

std::vector<std::string> segments_of(std::string_view path) {
  std::vector<std::string> segments;
  while (!path.empty()) {
    path.remove_prefix(1);
    const std::string_view segment = path.substr(0, path.find('/'));
    segments.emplace_back(segment);
    path.remove_prefix(segment.size());
  }
  return segments;
}

Problem role_needed(const Caller& caller, Role least) {
  return {.status = Status::forbidden,
          .code = "ROLE",
          .detail = caller.user + " is " + std::string(role_name(*caller.role)) + ".",
          .expected = std::string(role_name(least)),
          .next_step = "Log in as a user with that role, or ask an administrator for it."};
}

bool is_parameter(const std::string& segment) { return segment.starts_with('{'); }

std::optional<Parameters> match(const std::vector<std::string>& pattern,
                                const std::vector<std::string>& path) {
  if (pattern.size() != path.size()) {
    return std::nullopt;
  }
  Parameters parameters;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (is_parameter(pattern[i])) {
      parameters.push_back(path[i]);
    } else if (pattern[i] != path[i]) {
      return std::nullopt;
    }
  }
  return parameters;
}

}  // namespace

void Router::add(http::verb method, std::string_view pattern, Access access, Handler handler) {
  routes_.push_back(Route{method, segments_of(pattern), access, std::move(handler)});
}

boost::asio::awaitable<Reply> Router::route(const Request& request, const Caller& caller) const {
  const std::string path = path_of(request);
  const std::vector<std::string> segments = segments_of(path);
  std::string allowed;
  const std::vector<std::string>* pattern = nullptr;
  for (const Route& route : routes_) {
    const auto parameters = match(route.segments, segments);
    if (!parameters || (pattern != nullptr && *pattern != route.segments)) {
      continue;
    }
    pattern = &route.segments;
    if (route.method == request.method()) {
      if (auto problem = check(route.access, caller)) {
        co_return fail(std::move(*problem));
      }
      co_return co_await route.handler(Call{request, *parameters, caller});
    }
    allowed += (allowed.empty() ? "" : ", ") + std::string(http::to_string(route.method));
  }
  if (allowed.empty()) {
    co_return fail(not_found(path, "a path of spec/openapi.yaml"));
  }
  co_return fail({.status = Status::method_not_allowed,
                  .code = "METHOD_NOT_ALLOWED",
                  .detail = path + " does not answer " + std::string(request.method_string()) + ".",
                  .expected = allowed,
                  .headers = {{"Allow", allowed}}});
}

std::optional<Problem> Router::check(const Access& access, const Caller& caller) const {
  if (access.role) {
    if (!caller.role) {
      return login_needed();
    }
    if (*caller.role < *access.role) {
      return role_needed(caller, *access.role);
    }
  }
  return access.control ? need_control_(caller) : std::nullopt;
}

}  // namespace interlock::web
