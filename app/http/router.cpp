#include "http/router.hpp"

#include <optional>

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

void Router::add(http::verb method, std::string_view pattern, Handler handler) {
  routes_.push_back(Route{method, segments_of(pattern), std::move(handler)});
}

boost::asio::awaitable<Reply> Router::route(const Request& request) const {
  const std::string path = path_of(request);
  const std::vector<std::string> segments = segments_of(path);
  std::string allowed;
  for (const Route& route : routes_) {
    const auto parameters = match(route.segments, segments);
    if (!parameters) {
      continue;
    }
    if (route.method == request.method()) {
      co_return co_await route.handler(request, *parameters);
    }
    allowed += (allowed.empty() ? "" : ", ") + std::string(http::to_string(route.method));
  }
  if (!allowed.empty()) {
    co_return tl::make_unexpected(Problem{
        Status::method_not_allowed, "METHOD_NOT_ALLOWED",
        path + " does not answer " + std::string(request.method_string()) + ".", "", allowed, "", allowed});
  }
  co_return tl::make_unexpected(Problem{Status::not_found, "NOT_FOUND", "There is no " + path + ".", "",
                                        "a path of spec/openapi.yaml", "", ""});
}

}  // namespace interlock::web
