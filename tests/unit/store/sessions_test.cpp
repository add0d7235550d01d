#include "store/sessions.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "store_fixture.hpp"

namespace interlock {
namespace {

using namespace std::chrono_literals;

class SessionsTest : public StoreTest {
 protected:
  SessionsTest() {
    commit(store_, [](Transaction& transaction) {
      static_cast<void>(Users(transaction).add("ann", Role::admin, some_hash, noon).value());
      static_cast<void>(Users(transaction).add("bob", Role::viewer, some_hash, noon).value());
    });
  }

  NewSession create(const std::string& user, UtcTime now = noon) {
    return store_
        .transact([&](Transaction& transaction) -> Stored<NewSession> {
          return Sessions(transaction).create(user, now);
        })
        .value();
  }

  std::optional<Session> find(const std::string& token, UtcTime now) {
    return seen(store_, [&](Transaction& transaction) { return Sessions(transaction).find(token, now); });
  }

  void touch(std::uint32_t number, UtcTime now) {
    commit(store_, [&](Transaction& transaction) { Sessions(transaction).touch(number, now); });
  }

  Store store_ = open();
};

TEST_F(SessionsTest, TokenOpensItsSession) {
  const NewSession ann = create("ann");
  const NewSession bob = create("bob");
  EXPECT_EQ(find(ann.token, noon), ann.session);
  EXPECT_EQ(find(ann.token, noon)->user.role, Role::admin);
  EXPECT_EQ(find(bob.token, noon)->user.name, "bob");
  EXPECT_EQ(find("", noon), std::nullopt);
  EXPECT_EQ(find(ann.token + "A", noon), std::nullopt);
}

TEST_F(SessionsTest, TokenIsLongRandomAndNotInTheFile) {
  const NewSession first = create("ann");
  const NewSession second = create("ann");
  EXPECT_EQ(first.token.size(), 43u);
  EXPECT_EQ(first.token.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_"),
            std::string::npos);
  EXPECT_NE(first.token, second.token);
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    std::ifstream stream(entry.path(), std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(stream), {});
    EXPECT_THAT(bytes, testing::Not(testing::HasSubstr(first.token))) << entry.path();
  }
}

TEST_F(SessionsTest, EndsThirtyMinutesAfterItWasLastSeen) {
  const NewSession ann = create("ann");
  EXPECT_TRUE(find(ann.token, noon + 30min - 1ms));
  EXPECT_FALSE(find(ann.token, noon + 30min));
  touch(ann.session.number, noon + 20min);
  EXPECT_TRUE(find(ann.token, noon + 50min - 1ms));
  EXPECT_FALSE(find(ann.token, noon + 50min));
}

TEST_F(SessionsTest, EndsTwelveHoursAfterLoginHoweverBusy) {
  const NewSession ann = create("ann");
  EXPECT_EQ(ann.session.expires(), noon + 12h);
  for (UtcTime now = noon; now < noon + 12h; now += 20min) {
    touch(ann.session.number, now);
  }
  EXPECT_TRUE(find(ann.token, noon + 12h - 1ms));
  EXPECT_FALSE(find(ann.token, noon + 12h));
}

TEST_F(SessionsTest, OneThatIsOverIsNotRevivedByATouch) {
  const NewSession ann = create("ann");
  touch(ann.session.number, noon + 31min);
  EXPECT_FALSE(find(ann.token, noon + 31min));
}

TEST_F(SessionsTest, TouchInThePastTakesNothingAway) {
  const NewSession ann = create("ann");
  touch(ann.session.number, noon + 10min);
  touch(ann.session.number, noon + 5min);
  EXPECT_EQ(find(ann.token, noon + 11min)->last_seen, noon + 10min);
}

TEST_F(SessionsTest, DisabledUserHasNone) {
  const NewSession bob = create("bob");
  commit(store_, [](Transaction& transaction) {
    static_cast<void>(
        Users(transaction).change("bob", {.role = {}, .password = {}, .enabled = false}).value());
    EXPECT_EQ(Sessions(transaction).create("bob", noon).error().kind, StoreError::Kind::not_found);
    EXPECT_EQ(Sessions(transaction).create("eve", noon).error().kind, StoreError::Kind::not_found);
  });
  EXPECT_FALSE(find(bob.token, noon));
}

TEST_F(SessionsTest, SeventeenthEndsTheOldestOfThatUserOnly) {
  const NewSession bob = create("bob");
  std::vector<NewSession> sessions;
  for (int count = 0; count < sessions_of_one_user; ++count) {
    sessions.push_back(create("ann"));
    EXPECT_TRUE(sessions.back().ended.empty());
  }
  const NewSession last = create("ann");
  EXPECT_EQ(last.ended, std::vector<Session>{sessions.front().session});
  EXPECT_FALSE(find(sessions.front().token, noon));
  EXPECT_TRUE(find(sessions[1].token, noon));
  EXPECT_TRUE(find(last.token, noon));
  EXPECT_TRUE(find(bob.token, noon));
}

TEST_F(SessionsTest, NumbersAreNeverGivenTwice) {
  const std::uint32_t number = create("ann").session.number;
  commit(store_, [&](Transaction& transaction) { Sessions(transaction).end(number); });
  EXPECT_GT(create("ann").session.number, number);
}

TEST_F(SessionsTest, AllOfAUserEndButTheOneThatIsExcepted) {
  const NewSession first = create("ann");
  const NewSession second = create("ann");
  const NewSession bob = create("bob");
  commit(store_, [&](Transaction& transaction) {
    EXPECT_EQ(Sessions(transaction).end_all_of_user("ann", second.session.number),
              std::vector<Session>{first.session});
  });
  EXPECT_FALSE(find(first.token, noon));
  EXPECT_TRUE(find(second.token, noon));
  commit(store_, [&](Transaction& transaction) { Sessions(transaction).end_all_of_user("ann"); });
  EXPECT_FALSE(find(second.token, noon));
  EXPECT_TRUE(find(bob.token, noon));
}

TEST_F(SessionsTest, ExpiredOnesAreForgottenAndTold) {
  const NewSession old = create("ann");
  const NewSession young = create("bob", noon + 20min);
  commit(store_, [&](Transaction& transaction) {
    EXPECT_EQ(Sessions(transaction).end_expired(noon + 30min), std::vector<Session>{old.session});
    EXPECT_TRUE(Sessions(transaction).end_expired(noon + 30min).empty());
    EXPECT_TRUE(Sessions(transaction).find(young.session.number, noon + 30min));
  });
}

}  // namespace
}  // namespace interlock
