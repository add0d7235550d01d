#include "http/message.hpp"

#include <algorithm>
#include <boost/beast/core/string.hpp>
#include <charconv>
#include <string_view>

namespace interlock::web {
namespace {

namespace http = boost::beast::http;
using nlohmann::json;

/** A browser sends the most specific first; whoever sends more has made them up. */
constexpr std::size_t most_cookies = 4;

/** Headers that names in a path may carry bytes that are no UTF-8; they are shown as replacement characters.
 */
std::string text_of(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

Response response_of(Status status, std::string_view content_type, std::string body) {
  Response response{http_status(status), 11};
  response.set(http::field::content_type, content_type);
  response.set(http::field::cache_control, "no-store");
  response.body() = std::move(body);
  return response;
}

void add_text(json& body, const char* key, const std::string& text) {
  if (!text.empty()) {
    body[key] = text;
  }
}

/** Several cookies are several headers of one name. */
void add_headers(Response& response, const Headers& headers) {
  for (const auto& [name, value] : headers) {
    if (name == "Set-Cookie") {
      response.insert(name, value);
    } else {
      response.set(name, value);
    }
  }
}

/** Without its percent-encoding; nothing when that is malformed, or hides one of the `forbidden` bytes. */
std::optional<std::string> decoded(std::string_view encoded, std::string_view forbidden = {}) {
  std::string text;
  for (std::size_t i = 0; i < encoded.size(); ++i) {
    if (encoded[i] != '%') {
      text += encoded[i];
      continue;
    }
    unsigned byte = 0;
    const std::string_view digits = encoded.substr(i + 1, 2);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), byte, 16);
    if (digits.size() != 2 || error != std::errc{} || end != digits.data() + 2) {
      return std::nullopt;
    }
    if (forbidden.find(static_cast<char>(byte)) != std::string_view::npos) {
      return std::nullopt;
    }
    text += static_cast<char>(byte);
    i += 2;
  }
  return text;
}

constexpr const char* content_security_policy =
    "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; connect-src 'self'; img-src 'self' data:; "
    "object-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

}  // namespace

Response success_response(const Success& success) {
  Response response = success.text_type.empty()
                          ? response_of(success.status, "application/json", text_of(success.body))
                          : response_of(success.status, success.text_type, success.body.get<std::string>());
  add_headers(response, success.headers);
  return response;
}

Response problem_response(const Problem& problem) {
  json body{{"type", "about:blank"},
            {"title", std::string(http::obsolete_reason(http_status(problem.status)))},
            {"status", static_cast<unsigned>(problem.status)},
            {"code", problem.code},
            {"detail", problem.detail}};
  add_text(body, "field", problem.field);
  if (problem.line != 0) {
    body["line"] = problem.line;
  }
  add_text(body, "expected", problem.expected);
  add_text(body, "next_step", problem.next_step);
  Response response = response_of(problem.status, "application/problem+json", text_of(body));
  add_headers(response, problem.headers);
  return response;
}

std::optional<Problem> unreadable(const boost::beast::error_code& error) {
  namespace http = boost::beast::http;
  static const boost::beast::error_code of_the_protocol = http::error::bad_method;
  if (error.category() != of_the_protocol.category() || error == http::error::end_of_stream ||
      error == http::error::partial_message) {
    return std::nullopt;
  }
  if (error == http::error::body_limit) {
    return Problem{.status = Status::payload_too_large,
                   .code = "TOO_LARGE",
                   .detail = "The body is too large.",
                   .expected = "at most " + std::to_string(longest_body) +
                               " bytes; a trajectory of whoever is in control at most " +
                               std::to_string(longest_trajectory)};
  }
  if (error == http::error::header_limit || error == http::error::buffer_overflow) {
    return Problem{.status = Status::request_header_fields_too_large,
                   .code = "TOO_LARGE",
                   .detail = "The header is too large.",
                   .expected = "at most " + std::to_string(longest_header) + " bytes"};
  }
  return Problem{.status = Status::bad_request,
                 .code = "MALFORMED",
                 .detail = "This is no HTTP request: " + error.message() + ".",
                 .expected = "HTTP/1.1"};
}

std::optional<Problem> check_framing(const Request& header) {
  const std::size_t codings = header.count(http::field::transfer_encoding);
  if (codings == 0) {
    return std::nullopt;
  }
  if (header.count(http::field::content_length) != 0 || header.version() < 11) {
    return Problem{.status = Status::bad_request,
                   .code = "MALFORMED",
                   .detail = "The header does not say where the body ends.",
                   .expected = "HTTP/1.1 with either Content-Length or Transfer-Encoding"};
  }
  if (codings != 1 || !boost::beast::iequals(header[http::field::transfer_encoding], "chunked")) {
    return Problem{.status = Status::not_implemented,
                   .code = "NOT_IMPLEMENTED",
                   .detail = "This server does not know that Transfer-Encoding.",
                   .expected = "chunked, or a Content-Length"};
  }
  return std::nullopt;
}

void secure(boost::beast::http::fields& head) {
  head.set("Content-Security-Policy", content_security_policy);
  head.set("X-Content-Type-Options", "nosniff");
  head.set("Referrer-Policy", "no-referrer");
  head.set("Cross-Origin-Resource-Policy", "same-origin");
}

void prepare(Response& response, bool keep_alive) {
  secure(response);
  response.version(11);
  response.keep_alive(keep_alive);
  response.prepare_payload();
}

std::string path_of(const Request& request) {
  const std::string_view target(request.target().data(), request.target().size());
  constexpr std::string_view separators("/\\\0", 3);
  std::string path = decoded(target.substr(0, target.find_first_of("?#")), separators).value_or("");
  // What control was called before; goes with the version after this one.
  if (constexpr std::string_view former = "/api/authority"; path.starts_with(former)) {
    path.replace(0, former.size(), "/api/control");
  }
  return path;
}

tl::expected<json, Problem> parse_query(const Request& request) {
  std::string_view rest(request.target().data(), request.target().size());
  rest = rest.substr(0, rest.find('#'));
  rest = rest.substr(std::min(rest.find('?'), rest.size() - 1) + 1);
  json query = json::object();
  while (!rest.empty()) {
    const std::string_view pair = rest.substr(0, rest.find('&'));
    rest.remove_prefix(std::min(pair.size() + 1, rest.size()));
    const std::size_t equals = std::min(pair.find('='), pair.size());
    const auto name = decoded(pair.substr(0, equals));
    const auto value = decoded(pair.substr(std::min(equals + 1, pair.size())));
    if (!name || !value || query.contains(*name)) {
      return tl::make_unexpected(Problem{.status = Status::bad_request,
                                         .code = "MALFORMED",
                                         .detail = "The query is malformed at \"" + std::string(pair) + "\".",
                                         .expected = "name=value&..., percent-encoded, each name once"});
    }
    query[*name] = *value;
  }
  return query;
}

std::vector<std::string> cookies_of(const Request& request, std::string_view name) {
  std::vector<std::string> found;
  const auto [first, last] = request.equal_range(http::field::cookie);
  for (auto header = first; header != last; ++header) {
    std::string_view rest(header->value().data(), header->value().size());
    while (!rest.empty()) {
      const std::string_view pair = rest.substr(0, rest.find(';'));
      rest.remove_prefix(std::min(pair.size() + 1, rest.size()));
      const std::size_t start = std::min(pair.find_first_not_of(' '), pair.size());
      const std::size_t equals = pair.find('=', start);
      if (equals == std::string_view::npos || pair.substr(start, equals - start) != name) {
        continue;
      }
      const std::string_view value = pair.substr(equals + 1);
      if (found.size() < most_cookies && std::ranges::find(found, value) == found.end()) {
        found.emplace_back(value);
      }
    }
  }
  return found;
}

std::optional<std::uint32_t> number_in(std::string_view text) {
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = error == std::errc{} && end == text.data() + text.size();
  return whole ? std::optional(number) : std::nullopt;
}

tl::expected<json, Problem> parse_body(const Request& request) {
  if (const auto flaw = flaw_of_json(request.body())) {
    return tl::make_unexpected(Problem{.status = Status::bad_request,
                                       .code = "MALFORMED",
                                       .detail = "The body " + *flaw + ".",
                                       .expected = "one JSON object, each key once, at most " +
                                                   std::to_string(deepest_json) + " levels deep"});
  }
  json body = json::parse(request.body(), nullptr, false);
  if (body.is_discarded()) {
    return tl::make_unexpected(Problem{.status = Status::bad_request,
                                       .code = "MALFORMED",
                                       .detail = "The body is not JSON.",
                                       .expected = "one JSON object",
                                       .next_step = "Send Content-Type application/json and a JSON object."});
  }
  return body;
}

}  // namespace interlock::web
