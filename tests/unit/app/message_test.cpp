#include "http/message.hpp"

#include <gtest/gtest.h>

namespace interlock::web {
namespace {

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
  EXPECT_EQ(cookie_of(request, "interlock_session"), "abc-_123");
  EXPECT_EQ(cookie_of(request, "session"), std::nullopt);
}

TEST(Cookie, ThatComesTwiceIsNone) {
  Request request = request_for("/");
  request.set(http::field::cookie, "a=1; a=2");
  EXPECT_EQ(cookie_of(request, "a"), std::nullopt);
}

TEST(Headers, OfAnAnswerAreSent) {
  const Response made = json_response({Status::ok, json::object(), {{"Set-Cookie", "a=b"}}});
  EXPECT_EQ(made[http::field::set_cookie], "a=b");
  const Response refused =
      problem_response({.status = Status::too_many_requests, .headers = {{"Retry-After", "2"}}});
  EXPECT_EQ(refused[http::field::retry_after], "2");
}

}  // namespace
}  // namespace interlock::web
