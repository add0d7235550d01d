#include "http_fixture.hpp"

namespace interlock::web {
namespace {

using testing::HasSubstr;

class SessionTest : public HttpTest {
 protected:
  /** Name of the user whom the server sees behind these cookies; null for nobody. */
  json user_behind(const std::string& cookies) {
    Request request{http::verb::get, "/api/session", 11};
    request.set(http::field::cookie, cookies);
    const json user = json::parse(send(request).body)["user"];
    return user.is_null() ? user : user["name"];
  }

  std::string cookie_of(const std::string& token) {
    return "interlock_session_" + std::to_string(server_.port()) + "=" + token;
  }

  std::size_t streams() {
    std::size_t count = 0;
    in_network([&] { count = api_.stream().subscribers().size(); });
    return count;
  }
};

TEST_F(SessionTest, TheCookieOfARobotAtAnotherPortIsNotItsOwn) {
  const std::string other = "interlock_session_1=" + token_;
  EXPECT_TRUE(user_behind(other).is_null());
  EXPECT_EQ(user_behind(other + "; " + cookie()), "edna");
}

TEST_F(SessionTest, ASecondCookieOfTheNameTakesNothingAway) {
  EXPECT_EQ(user_behind(cookie() + "; " + cookie_of(std::string(43, 'A'))), "edna");
  EXPECT_EQ(user_behind(cookie_of("x") + "; " + cookie()), "edna");
  EXPECT_EQ(user_behind(cookie() + "; " + cookie()), "edna");
}

TEST_F(SessionTest, CookiesOfTwoSessionsLeaveOpenWhichIsMeant) {
  EXPECT_TRUE(user_behind(cookie() + "; " + cookie_of(token_of("ada"))).is_null());
}

TEST_F(SessionTest, WhoeverSetsTheClockEndsNoSessionAndNoControl) {
  auto watching = as(token_of("vic"), [this] { return open_stream(); });
  set_clock(std::chrono::minutes(20));
  for (int state = 0; state < 3; ++state) {  // With each of them idle sessions are looked for.
    ASSERT_TRUE(watching.next());
  }
  EXPECT_EQ(get("/api/motors").status, 503u) << "logged in, only without a kernel";
  EXPECT_EQ(json::parse(get("/api/control").body)["mine"], true);
}

TEST_F(SessionTest, SettingTheClockBackProlongsNoSession) {
  set_clock(-std::chrono::hours(1));
  pass(std::chrono::minutes(31));
  EXPECT_EQ(get("/api/motors").status, 401u);
}

TEST_F(SessionTest, OneSessionDoesNotTakeEveryStream) {
  std::vector<test::StreamClient> own;
  for (std::size_t i = 0; i < Broadcaster::session_capacity; ++i) {
    own.push_back(open_stream());
  }
  EXPECT_EQ(status_of_one_more_stream(), 503u);
  log_in("vic");
  auto other = open_stream();
  EXPECT_EQ(streams(), Broadcaster::session_capacity + 1);
}

TEST_F(SessionTest, AStreamThatTakesNothingDoesNotOutliveItsSession) {
  auto stalled = open_stream();
  // More than the connection's buffers hold, so that the server's writing stands still.
  const std::string long_text(1u << 20u, 'x');
  in_network([&] {
    for (int i = 0; i < 64; ++i) {
      api_.stream().send_text(json{{"type", "filler"}, {"text", long_text}});
    }
  });
  ASSERT_EQ(post("/api/logout").status, 200u);
  while (streams() != 0) {
    std::this_thread::yield();
  }
  std::vector<std::string> warnings;
  for (const LogLine& line : log_->ring().newest(LogRing::capacity, LogLevel::warning)) {
    warnings.push_back(line.text);
  }
  EXPECT_THAT(warnings, testing::Contains(HasSubstr("did not take its end")));
}

TEST_F(SessionTest, ManyLoginsOfOtherNamesAtTheSameTimeLockNobodyOut) {
  std::vector<std::future<Answered>> strangers;
  for (int i = 0; i < 8; ++i) {
    strangers.push_back(std::async(std::launch::async, [this, i] {
      Request request{http::verb::post, "/api/login", 11,
                      json{{"name", "stranger" + std::to_string(i)}, {"password", "a long password"}}.dump()};
      request.set(http::field::cookie, "none=1");
      return send(request);
    }));
  }
  for (auto& each : strangers) {
    EXPECT_EQ(each.get().problem()["code"], "CREDENTIALS");
  }
}

TEST_F(SessionTest, NoPathForgesALineOfTheLog) {
  log_->set_level(LogLevel::debug);
  (void)get("/api/nothing%0A2024-01-01T00:00:00.000Z%20critical%20forged%1b[0m");
  for (const LogLine& line : log_->ring().after(0)) {
    EXPECT_EQ(line.text.find('\n'), std::string::npos) << line.text;
    EXPECT_EQ(line.text.find('\x1b'), std::string::npos) << line.text;
  }
}

}  // namespace
}  // namespace interlock::web
