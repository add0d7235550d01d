#include "http/message.hpp"

#include <charconv>
#include <string_view>

namespace interlock::web {
namespace {

namespace http = boost::beast::http;
using nlohmann::json;

/** Headers that names in a path may carry bytes that are no UTF-8; they are shown as replacement characters.
 */
std::string text_of(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

Response response_of(Status status, const char* content_type, const json& body) {
  Response response{status, 11};
  response.set(http::field::content_type, content_type);
  response.set(http::field::cache_control, "no-store");
  response.body() = text_of(body);
  return response;
}

void add_text(json& body, const char* key, const std::string& text) {
  if (!text.empty()) {
    body[key] = text;
  }
}

}  // namespace

Response json_response(const Success& success) {
  return response_of(success.status, "application/json", success.body);
}

Response problem_response(const Problem& problem) {
  json body{{"type", "about:blank"},
            {"title", std::string(http::obsolete_reason(problem.status))},
            {"status", static_cast<unsigned>(problem.status)},
            {"code", problem.code},
            {"detail", problem.detail}};
  add_text(body, "field", problem.field);
  add_text(body, "expected", problem.expected);
  add_text(body, "next_step", problem.next_step);
  Response response = response_of(problem.status, "application/problem+json", body);
  if (!problem.allow.empty()) {
    response.set(http::field::allow, problem.allow);
  }
  return response;
}

std::string path_of(const Request& request) {
  const std::string_view target(request.target().data(), request.target().size());
  const std::string_view encoded = target.substr(0, target.find_first_of("?#"));
  std::string path;
  for (std::size_t i = 0; i < encoded.size(); ++i) {
    if (encoded[i] != '%') {
      path += encoded[i];
      continue;
    }
    unsigned byte = 0;
    const std::string_view digits = encoded.substr(i + 1, 2);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), byte, 16);
    if (digits.size() != 2 || error != std::errc{} || end != digits.data() + 2) {
      return "";
    }
    path += static_cast<char>(byte);
    i += 2;
  }
  return path;
}

tl::expected<json, Problem> parse_body(const Request& request) {
  json body = json::parse(request.body(), nullptr, false);
  if (body.is_discarded()) {
    return tl::make_unexpected(Problem{Status::bad_request, "MALFORMED", "The body is not JSON.", "",
                                       "one JSON object",
                                       "Send Content-Type application/json and a JSON object.", ""});
  }
  return body;
}

}  // namespace interlock::web
