#include <algorithm>

#include "http_fixture.hpp"
#include "service/login_guard.hpp"

namespace interlock::web {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr const char* password = "correct horse battery";

/** With a user `max` whose password is known. */
class AccountTest : public HttpTest {
 protected:
  AccountTest() {
    ada_ = token_of("ada");
    const Answered added = as(ada_, [this] {
      return post("/api/users", json{{"name", "max"}, {"role", "engineer"}, {"password", password}}.dump());
    });
    EXPECT_EQ(added.status, 201u) << added.body;
    become_nobody();
  }

  Answered try_login(const std::string& name, const std::string& tried) {
    return post("/api/login", json{{"name", name}, {"password", tried}}.dump());
  }

  /** Token of a session that was opened by logging in. */
  std::string token_by_login(const std::string& name, const std::string& tried) {
    const Answered answered = try_login(name, tried);
    EXPECT_EQ(answered.status, 200u) << answered.body;
    const std::string cookie(answered.headers[http::field::set_cookie]);
    const std::size_t start = cookie.find('=') + 1;
    return cookie.substr(start, cookie.find(';') - start);
  }

  Answered change(const std::string& user, const json& body) {
    return as(ada_, [&] { return put("/api/users/" + user, body.dump()); });
  }

  json session_of(const std::string& token) {
    return as(token, [this] { return json::parse(get("/api/session").body); });
  }

  std::string ada_;
};

TEST_F(AccountTest, LoginOpensASessionByAStrictCookie) {
  const Answered answered = try_login("max", password);
  ASSERT_EQ(answered.status, 200u);
  EXPECT_THAT(std::string(answered.headers[http::field::set_cookie]),
              AllOf(HasSubstr("interlock_session_" + std::to_string(server_.port()) + "="),
                    HasSubstr("; HttpOnly"), HasSubstr("; SameSite=Strict"), HasSubstr("; Path=/")));
  const json session = json::parse(answered.body);
  EXPECT_EQ(session["user"]["name"], "max");
  EXPECT_EQ(session["expires"], iso_8601(now() + std::chrono::hours(12)));
  EXPECT_EQ(audit("login").size(), 1u);
}

TEST_F(AccountTest, AWrongPasswordAndAnUnknownNameAreTheSame) {
  const Answered wrong = try_login("max", "wrong horse battery");
  const Answered unknown = try_login("nobody.here", password);
  EXPECT_EQ(wrong.status, 401u);
  EXPECT_EQ(wrong.problem()["code"], "CREDENTIALS");
  EXPECT_EQ(wrong.body, unknown.body);
  EXPECT_EQ(wrong.headers.count(http::field::set_cookie), 0u);
}

TEST_F(AccountTest, ADisabledUserCannotLogIn) {
  ASSERT_EQ(change("max", {{"enabled", false}}).status, 200u);
  EXPECT_EQ(try_login("max", password).problem()["code"], "CREDENTIALS");
}

TEST_F(AccountTest, AfterWrongPasswordsTheRightOneIsLetInAfterADelay) {
  for (int i = 0; i < 4; ++i) {
    ASSERT_EQ(try_login("max", "wrong horse battery").status, 401u);
  }
  const auto before = std::chrono::steady_clock::now();
  EXPECT_EQ(try_login("max", password).status, 200u);
  EXPECT_GE(std::chrono::steady_clock::now() - before, std::chrono::seconds(2));
  EXPECT_EQ(try_login("max", "wrong horse battery").status, 401u) << "a success ends the delay";
}

TEST_F(AccountTest, ManyAttemptsAtTheSameTimeAreRefusedButNotOfTheBrowserThatTheUserHas) {
  const Answered login = try_login("max", password);
  const auto [first, last] = login.headers.equal_range(http::field::set_cookie);
  ASSERT_EQ(std::distance(first, last), 2);
  const std::string known(std::next(first)->value());
  for (int i = 0; i < 4; ++i) {
    ASSERT_EQ(try_login("max", "wrong horse battery").status, 401u);
  }
  std::vector<std::future<Answered>> flood;
  for (std::size_t i = 0; i < 2 * LoginGuard::pair_places; ++i) {
    flood.push_back(std::async(std::launch::async, [this] { return try_login("max", "a guess"); }));
  }
  // The first to be refused shows that the places are taken, each of them for two seconds at least.
  const auto is_done = [](const auto& each) {
    return each.valid() && each.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  };
  auto refused = flood.end();
  while (refused == flood.end()) {
    refused = std::ranges::find_if(flood, is_done);
  }
  const Answered full = refused->get();
  EXPECT_EQ(full.status, 429u);
  EXPECT_EQ(full.problem()["code"], "BACK_OFF");
  EXPECT_EQ(full.headers[http::field::retry_after], "1");
  Request request{http::verb::post, "/api/login", 11, json{{"name", "max"}, {"password", password}}.dump()};
  request.set(http::field::cookie, known.substr(0, known.find(';')));
  EXPECT_EQ(send(request).status, 200u);
}

TEST_F(AccountTest, AUserSeesAndEndsTheOwnSessionsOnly) {
  const std::string mine = token_by_login("max", password);
  const std::string other = token_by_login("max", password);
  (void)session_of(other);
  const json list = as(mine, [this] { return json::parse(get("/api/sessions").body); });
  ASSERT_EQ(list.size(), 2u) << list;
  EXPECT_EQ(list[0]["mine"], false);
  EXPECT_EQ(list[1]["mine"], true);
  EXPECT_EQ(list[1]["user"], "max");
  EXPECT_EQ(list[1]["since"], iso_8601(now()));
  EXPECT_EQ(list[1]["last_use"], iso_8601(now()));
  EXPECT_THAT(list[1]["address"].get<std::string>(), testing::StartsWith("127.0.0.1:"));
  const auto end = [&](const std::string& token, const json& number) {
    return as(token,
              [&] { return send({http::verb::delete_, "/api/sessions/" + number.dump(), 11}).status; });
  };
  const json of_ada = session_of(ada_)["session"];
  EXPECT_EQ(end(mine, of_ada), 404u);
  EXPECT_EQ(end(mine, 999'999), 404u);
  EXPECT_EQ(end(mine, "x"), 404u);
  EXPECT_EQ(session_of(ada_)["user"]["name"], "ada");
  EXPECT_EQ(end(mine, list[0]["session"]), 200u);
  EXPECT_TRUE(session_of(other)["user"].is_null());
  EXPECT_EQ(session_of(mine)["user"]["name"], "max");
  ASSERT_EQ(audit("session_ended").size(), 1u);
  EXPECT_EQ(audit("session_ended").back()["session"], list[0]["session"]);
  EXPECT_EQ(end(mine, list[1]["session"]), 200u);
  EXPECT_EQ(end(mine, list[1]["session"]), 401u);
}

TEST_F(AccountTest, AnAdministratorSeesAndEndsTheSessionsOfOthers) {
  const std::string token = token_by_login("max", password);
  const json number = session_of(token)["session"];
  const json list = as(ada_, [this] { return json::parse(get("/api/sessions").body); });
  const auto found = std::ranges::find_if(list, [&](const json& each) { return each["session"] == number; });
  ASSERT_NE(found, list.end());
  EXPECT_EQ((*found)["user"], "max");
  EXPECT_EQ(
      as(ada_, [&] { return send({http::verb::delete_, "/api/sessions/" + number.dump(), 11}).status; }),
      200u);
  EXPECT_TRUE(session_of(token)["user"].is_null());
  EXPECT_EQ(audit("session_ended").back()["user"], "max");
}

TEST_F(AccountTest, ARefusalForTheRoleIsLoggedAndCounted) {
  const std::string token = token_of("vic");
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(as(token, [this] { return get("/api/users"); }).problem()["code"], "ROLE");
  }
  EXPECT_THAT(get("/api/metrics").body, HasSubstr("\ninterlock_role_refusals_total 3\n"));
  EXPECT_THAT(get("/api/metrics").body, HasSubstr("\ninterlock_log_lines_lost_total 0\n"));
  std::vector<std::string> warnings;
  for (const LogLine& line : log_->ring().newest(LogRing::capacity, LogLevel::warning)) {
    if (line.text.starts_with("vic was refused GET /api/users")) {
      warnings.push_back(line.text);
    }
  }
  EXPECT_EQ(warnings.size(), 1u) << "the log takes repetitions together";
}

TEST_F(AccountTest, NoPasswordIsInTheAudit) {
  (void)token_by_login("max", password);
  (void)try_login("max", "wrong horse battery");
  (void)try_login("typed in the wrong field", "x");
  for (const AuditRecord& record : audit()) {
    EXPECT_THAT(record.detail, AllOf(Not(HasSubstr("horse")), Not(HasSubstr("typed in the wrong field"))))
        << record.kind;
  }
  EXPECT_EQ(audit("login_refused").size(), 2u);
}

TEST_F(AccountTest, ASessionChosenByTheBrowserIsNeverOpened) {
  const std::string chosen(43, 'A');
  const std::string given = as(chosen, [this] { return token_by_login("max", password); });
  EXPECT_NE(given, chosen);
  EXPECT_TRUE(session_of(chosen)["user"].is_null());
  EXPECT_EQ(session_of(given)["user"]["name"], "max");
}

TEST_F(AccountTest, ANewLoginEndsTheSessionThatTheBrowserHad) {
  const std::string first = token_by_login("max", password);
  const std::string second = as(first, [this] { return token_by_login("max", password); });
  EXPECT_TRUE(session_of(first)["user"].is_null());
  EXPECT_EQ(session_of(second)["user"]["name"], "max");
}

TEST_F(AccountTest, LogoutEndsTheSession) {
  const std::string token = token_by_login("max", password);
  const Answered answered = as(token, [this] { return post("/api/logout"); });
  EXPECT_EQ(answered.status, 200u);
  EXPECT_TRUE(json::parse(answered.body)["user"].is_null());
  EXPECT_THAT(std::string(answered.headers[http::field::set_cookie]), HasSubstr("Max-Age=0"));
  EXPECT_EQ(as(token, [this] { return get("/api/motors"); }).status, 401u);
  EXPECT_EQ(audit("logout").size(), 1u);
}

TEST_F(AccountTest, ASessionEndsThirtyMinutesAfterItsLastRequest) {
  const std::string token = token_of("max");
  for (int i = 0; i < 3; ++i) {
    pass(std::chrono::minutes(29));
    EXPECT_EQ(session_of(token)["user"]["name"], "max");
    wait_until_use_is_stored(token);
  }
  pass(std::chrono::minutes(30));
  EXPECT_TRUE(session_of(token)["user"].is_null());
}

TEST_F(AccountTest, ASessionEndsTwelveHoursAfterLoginHoweverItIsUsed) {
  const std::string token = token_of("max");
  for (int i = 0; i < 35; ++i) {
    pass(std::chrono::minutes(20));
    ASSERT_EQ(session_of(token)["user"]["name"], "max") << i;
    wait_until_use_is_stored(token);
  }
  pass(std::chrono::minutes(20));
  EXPECT_TRUE(session_of(token)["user"].is_null());
}

TEST_F(AccountTest, TheSeventeenthSessionOfAUserEndsTheOldest) {
  const std::string oldest = token_by_login("max", password);
  std::string newest;
  for (int i = 0; i < sessions_of_one_user; ++i) {
    EXPECT_EQ(session_of(oldest)["user"]["name"], "max") << i;
    newest = token_by_login("max", password);
  }
  EXPECT_TRUE(session_of(oldest)["user"].is_null());
  EXPECT_EQ(session_of(newest)["user"]["name"], "max");
}

TEST_F(AccountTest, ANewPasswordNeedsTheCurrentOneAndEndsTheOtherSessions) {
  const std::string token = token_by_login("max", password);
  const std::string other = token_by_login("max", password);
  const auto change_to = [&](const std::string& current, const std::string& next) {
    return as(token, [&] { return put("/api/password", json{{"current", current}, {"new", next}}.dump()); });
  };
  EXPECT_EQ(change_to("wrong horse battery", "a much better one").problem()["code"], "CREDENTIALS");
  EXPECT_EQ(change_to(password, "short").problem()["field"], "new");
  EXPECT_EQ(session_of(other)["user"]["name"], "max");
  EXPECT_EQ(change_to(password, "a much better one").status, 200u);
  EXPECT_EQ(session_of(token)["user"]["name"], "max");
  EXPECT_TRUE(session_of(other)["user"].is_null());
  EXPECT_EQ(try_login("max", password).status, 401u);
  EXPECT_EQ(try_login("max", "a much better one").status, 200u);
}

TEST_F(AccountTest, UsersAreListedAddedAndChangedByAdministratorsOnly) {
  for (const char* const name : {"edna", "vic"}) {
    const std::string token = token_of(name);
    EXPECT_EQ(as(token, [this] { return get("/api/users"); }).problem()["code"], "ROLE") << name;
    EXPECT_EQ(as(token, [this] { return put("/api/users/max", R"({"role":"admin"})"); }).status, 403u);
  }
  const json users = json::parse(as(ada_, [this] { return get("/api/users"); }).body);
  ASSERT_EQ(users.size(), 4u);
  EXPECT_EQ(users[2]["name"], "max");
  EXPECT_EQ(users[2]["role"], "engineer");
  const json again{{"name", "max"}, {"role", "viewer"}, {"password", password}};
  EXPECT_EQ(as(ada_, [&] { return post("/api/users", again.dump()); }).problem()["code"], "EXISTS");
  EXPECT_EQ(change("nobody.here", {{"role", "viewer"}}).status, 404u);
  EXPECT_EQ(change("max", {{"role", "king"}}).problem()["field"], "role");
  EXPECT_EQ(change("max", {{"password", "short"}}).problem()["field"], "password");
}

TEST_F(AccountTest, AChangedUserHasNoSessionLeft) {
  const std::string token = token_of("max");
  EXPECT_EQ(session_of(token)["user"]["role"], "engineer");
  EXPECT_EQ(change("max", json::object()).status, 200u);
  EXPECT_EQ(session_of(token)["user"]["role"], "engineer") << "nothing was changed";
  EXPECT_EQ(change("max", {{"role", "viewer"}}).status, 200u);
  EXPECT_TRUE(session_of(token)["user"].is_null());
}

TEST_F(AccountTest, SomebodyIsLeftWhoCanAdminister) {
  for (const json& body : {json{{"role", "viewer"}}, json{{"enabled", false}}}) {
    EXPECT_EQ(change("ada", body).problem()["code"], "LAST_ADMIN");
  }
  EXPECT_EQ(session_of(ada_)["user"]["role"], "admin");
}

TEST_F(AccountTest, ASessionThatEndsInTheStoreEndsHereToo) {
  const std::string token = token_of("max");
  ASSERT_EQ(session_of(token)["user"]["name"], "max");
  ASSERT_TRUE(mine_.transact([](Transaction& transaction) -> Stored<void> {
    Sessions(transaction).end_all_of_user("max");
    return {};
  }));
  while (!session_of(token)["user"].is_null()) {
    std::this_thread::yield();
  }
}

}  // namespace
}  // namespace interlock::web
