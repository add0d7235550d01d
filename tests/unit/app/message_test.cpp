#include "http/message.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "http/same_origin.hpp"

namespace interlock::web {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

namespace http = boost::beast::http;
using nlohmann::json;

Request request_for(const std::string& target) { return {http::verb::get, target, 11}; }

TEST(Query, IsAnObjectOfTexts) {
  EXPECT_EQ(parse_query(request_for("/api/logs")), json::object());
  EXPECT_EQ(parse_query(request_for("/api/logs?")), json::object());
  EXPECT_EQ(parse_query(request_for("/api/logs?lines=5&level=info#x")),
            (json{{"lines", "5"}, {"level", "info"}}));
  EXPECT_EQ(parse_query(request_for("/api/logs?a%20b=%3d&c=1=2&d")),
            (json{{"a b", "="}, {"c", "1=2"}, {"d", ""}}));
}

TEST(Query, ThatIsMalformedNamesThePlace) {
  for (const std::string query : {"a=%", "a=%zz", "a=1&a=2", "%f=1"}) {
    const auto parsed = parse_query(request_for("/api/logs?" + query));
    ASSERT_FALSE(parsed) << query;
    EXPECT_EQ(parsed.error().code, "MALFORMED");
  }
}

TEST(Cookie, IsFoundAmongOthers) {
  Request request = request_for("/");
  request.set(http::field::cookie, "theme={\"dark\"}; interlock_session=abc-_123; x");
  EXPECT_THAT(cookies_of(request, "interlock_session"), ElementsAre("abc-_123"));
  EXPECT_THAT(cookies_of(request, "session"), ElementsAre());
}

TEST(Cookie, HasEachOfItsValuesOnceAndNotMoreThanFour) {
  Request request = request_for("/");
  request.set(http::field::cookie, "a=1; a=2; a=1");
  EXPECT_THAT(cookies_of(request, "a"), ElementsAre("1", "2"));
  request.set(http::field::cookie, "a=1; a=2; a=3; a=4; a=5");
  EXPECT_EQ(cookies_of(request, "a").size(), 4u);
}

TEST(Cookie, OfTheSessionNamesThePortThatTheBrowserCameTo) {
  const std::pair<const char*, const char*> cases[] = {{"127.0.0.1:8080", "interlock_session_8080"},
                                                       {"[::1]:8081", "interlock_session_8081"},
                                                       {"[::1]", "interlock_session_80"},
                                                       {"localhost", "interlock_session_80"}};
  for (const auto& [host, name] : cases) {
    Request request = request_for("/");
    request.set(http::field::host, host);
    EXPECT_EQ(session_cookie(request), name);
  }
}

Request with_headers(const std::vector<std::pair<http::field, std::string>>& headers, unsigned version = 11) {
  Request request{http::verb::post, "/", version};
  for (const auto& [name, value] : headers) {
    request.insert(name, value);
  }
  return request;
}

TEST(Framing, IsByLengthOrByChunks) {
  EXPECT_FALSE(check_framing(with_headers({})));
  EXPECT_FALSE(check_framing(with_headers({{http::field::content_length, "3"}})));
  EXPECT_FALSE(check_framing(with_headers({{http::field::transfer_encoding, "chunked"}})));
  EXPECT_FALSE(check_framing(with_headers({{http::field::transfer_encoding, "Chunked"}})));
}

TEST(Framing, ByAnUnknownOrAStackedCodingIsNotImplemented) {
  for (const char* const coding : {"gzip", "gzip, chunked", "chunked, chunked", "identity", "xchunked", ""}) {
    const auto refused = check_framing(with_headers({{http::field::transfer_encoding, coding}}));
    ASSERT_TRUE(refused) << coding;
    EXPECT_EQ(refused->status, Status::not_implemented) << coding;
    EXPECT_EQ(refused->code, "NOT_IMPLEMENTED") << coding;
  }
  EXPECT_TRUE(check_framing(
      with_headers({{http::field::transfer_encoding, "gzip"}, {http::field::transfer_encoding, "chunked"}})));
}

TEST(Framing, ByTwoMeansIsMalformed) {
  for (const char* const coding : {"gzip", "chunked"}) {
    const auto refused = check_framing(
        with_headers({{http::field::transfer_encoding, coding}, {http::field::content_length, "3"}}));
    ASSERT_TRUE(refused) << coding;
    EXPECT_EQ(refused->status, Status::bad_request) << coding;
  }
  EXPECT_TRUE(check_framing(with_headers({{http::field::transfer_encoding, "chunked"}}, 10)));
}

TEST(Host, IsNamedOnce) {
  const auto twice =
      check_host(with_headers({{http::field::host, "localhost"}, {http::field::host, "localhost"}}), {});
  ASSERT_TRUE(twice);
  EXPECT_EQ(twice->code, "MALFORMED");
  const auto none = check_host(with_headers({}), {});
  ASSERT_TRUE(none);
  EXPECT_EQ(none->code, "MALFORMED");
  EXPECT_FALSE(check_host(with_headers({{http::field::host, "localhost"}}), {}));
}

TEST(Host, IsThisMachineOrThePublicNameOfItsProxy) {
  const ReverseProxy proxy{.origin = "https://robot.example:8443", .address = {}};
  for (const char* const host : {"127.0.0.1:8080", "robot.example", "robot.example:8443"}) {
    EXPECT_FALSE(check_host(with_headers({{http::field::host, host}}), proxy)) << host;
  }
  for (const char* const host : {"robot.example.evil", "evil.robot.example", ""}) {
    EXPECT_TRUE(check_host(with_headers({{http::field::host, host}}), proxy)) << host;
  }
  EXPECT_TRUE(check_host(with_headers({{http::field::host, "robot.example"}}), {}));
}

TEST(Origin, IsThatOfThePublicNameWithTlsBehindAProxy) {
  const ReverseProxy proxy{.origin = "https://robot.example", .address = {}};
  const auto refused = [&](const char* host, const char* origin) {
    return check_origin(with_headers({{http::field::host, host}, {http::field::origin, origin}}), proxy)
        .has_value();
  };
  EXPECT_FALSE(refused("127.0.0.1:8080", "https://robot.example")) << "as nginx has it by default";
  EXPECT_FALSE(refused("robot.example", "https://robot.example"));
  EXPECT_FALSE(refused("127.0.0.1:8080", "http://127.0.0.1:8080")) << "the console on this machine";
  EXPECT_TRUE(refused("robot.example", "http://robot.example")) << "no TLS: anybody may have sent that page";
  EXPECT_TRUE(refused("robot.example", "https://robot.example.evil"));
  EXPECT_TRUE(refused("127.0.0.1:8080", "null"));
}

Request forwarded_for(const char* clients) {
  Request request{http::verb::post, "/", 11};
  request.set("X-Forwarded-For", clients);
  return request;
}

TEST(Client, IsWhomTheTrustedProxyNamesLast) {
  const ReverseProxy proxy{.origin = {}, .address = "127.0.0.1"};
  const Request one = forwarded_for("10.9.9.9, 192.168.1.7");
  EXPECT_EQ(client_of(one, "127.0.0.1:5000", proxy), "192.168.1.7:5000");
  EXPECT_EQ(client_of(one, "127.0.0.2:5000", proxy), "127.0.0.2:5000") << "another process of this machine";
  EXPECT_EQ(client_of(one, "127.0.0.1:5000", {}), "127.0.0.1:5000") << "no proxy is trusted";
  Request two = one;
  two.insert("X-Forwarded-For", "2001:db8::1");
  EXPECT_EQ(client_of(two, "127.0.0.1:5000", proxy), "[2001:db8::1]:5000");
  for (const char* const text : {"", "nobody", "10.0.0.1,", "10.0.0.1:80"}) {
    const Request unnamed = forwarded_for(text);
    EXPECT_EQ(client_of(unnamed, "127.0.0.1:5000", proxy), "127.0.0.1:5000") << text;
  }
  EXPECT_EQ(client_of(one, "[::1]:5000", {.origin = {}, .address = "::1"}), "192.168.1.7:5000");
}

TEST(Proxy, IsGivenAsAnOriginWithTlsAndAnAddress) {
  EXPECT_FALSE(problem_of(ReverseProxy{}));
  EXPECT_FALSE(problem_of(ReverseProxy{.origin = "https://robot.example:8443", .address = "::1"}));
  for (const char* const origin :
       {"robot.example", "http://robot.example", "https://", "https://robot.example/"}) {
    EXPECT_TRUE(problem_of(ReverseProxy{.origin = origin, .address = {}})) << origin;
  }
  EXPECT_TRUE(problem_of(ReverseProxy{.origin = {}, .address = "proxy"}));
}

TEST(Path, HasNoSeparatorThatWasEncoded) {
  EXPECT_EQ(path_of(request_for("/api/%6dotors?x=%2f#%2f")), "/api/motors");
  EXPECT_EQ(path_of(request_for("/api/users/%252f")), "/api/users/%2f");
  for (const char* const target :
       {"/api%2fstop", "/api/motors/3%2Fenable", "/api%5cstop", "/a%5C", "/a%00"}) {
    EXPECT_EQ(path_of(request_for(target)), "") << target;
  }
}

tl::expected<json, Problem> parsed(const std::string& body) {
  Request request = request_for("/");
  request.body() = body;
  return parse_body(request);
}

TEST(Body, MayNotNestDeeperThanSixtyFour) {
  const auto nested = [](std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); };
  EXPECT_TRUE(parsed(nested(64)));
  for (const std::size_t depth : {65u, 10'000u, 30'000u}) {
    const auto refused = parsed(nested(depth));
    ASSERT_FALSE(refused) << depth;
    EXPECT_EQ(refused.error().status, Status::bad_request);
    EXPECT_THAT(refused.error().expected, HasSubstr("64"));
  }
}

TEST(Body, MayNotHaveAKeyTwiceInOneObject) {
  const auto refused = parsed(R"({"a":1,"b":[{"x":1,"x":2}]})");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, "MALFORMED");
  EXPECT_THAT(refused.error().detail, HasSubstr("\"x\""));
  EXPECT_TRUE(parsed(R"({"a":{"x":1},"b":{"x":2},"x":[{"x":1},{"x":1}]})"));
}

TEST(Headers, OfAnAnswerAreSent) {
  const Response made = success_response({Status::ok, json::object(), {{"Set-Cookie", "a=b"}}});
  EXPECT_EQ(made[http::field::set_cookie], "a=b");
  const Response refused =
      problem_response({.status = Status::too_many_requests, .headers = {{"Retry-After", "2"}}});
  EXPECT_EQ(refused[http::field::retry_after], "2");
}

}  // namespace
}  // namespace interlock::web
