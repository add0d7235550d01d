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
