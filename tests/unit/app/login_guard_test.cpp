#include "service/login_guard.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace interlock::web {
namespace {

using std::chrono::seconds;

constexpr SteadyTime start{};

class LoginGuardTest : public testing::Test {
 protected:
  using Attempt = LoginGuard::Attempt;
  using Source = LoginGuard::Source;

  std::optional<Attempt> begin(const Source& source, SteadyTime now = start) {
    return guard_.begin(source, now);
  }

  void try_wrong(const Source& source, int times = 1, SteadyTime now = start) {
    for (int i = 0; i < times; ++i) {
      auto attempt = begin(source, now);
      ASSERT_TRUE(attempt);
      attempt->judged(false);
    }
  }

  /** How long the next attempt would wait. */
  seconds delay(const Source& source, SteadyTime now = start) {
    const auto attempt = begin(source, now);
    return attempt ? attempt->delay() : seconds::max();
  }

  LoginGuard guard_;
  Source max_{"10.0.0.1", "max", ""};
};

TEST_F(LoginGuardTest, TheDelayDoublesFromOneSecondToFourAndKeepsNobodyOut) {
  for (const int expected : {0, 0, 0, 1, 2, 4, 4, 4}) {
    EXPECT_EQ(delay(max_), seconds(expected));
    try_wrong(max_);
  }
  try_wrong(max_, 10'000);
  EXPECT_EQ(delay(max_), LoginGuard::longest_delay);
}

TEST_F(LoginGuardTest, GuessesFromOneAddressDoNotDelayTheNameAtAnother) {
  try_wrong(max_, 1000);
  EXPECT_EQ(delay({"10.0.0.2", "max", ""}), seconds(0));
}

TEST_F(LoginGuardTest, GuessesForManyNamesDelayTheAddress) {
  for (int i = 0; i < 100; ++i) {
    try_wrong({"10.0.0.1", "user" + std::to_string(i), ""});
  }
  EXPECT_EQ(delay({"10.0.0.1", "another", ""}), LoginGuard::longest_delay);
  EXPECT_EQ(delay({"10.0.0.2", "another", ""}), seconds(0));
}

TEST_F(LoginGuardTest, ASuccessEndsTheDelayOfThePairAndNotOfTheAddress) {
  try_wrong(max_, 5);
  begin(max_)->judged(true);
  EXPECT_EQ(delay(max_), seconds(0));
  try_wrong({"10.0.0.1", "eve", ""}, 100);
  begin(max_)->judged(true);
  EXPECT_EQ(delay(max_), LoginGuard::longest_delay);
}

TEST_F(LoginGuardTest, WrongPasswordsAreForgottenOnceNoneHasComeForAWhile) {
  try_wrong(max_, 100);
  EXPECT_EQ(delay(max_, start + LoginGuard::memory - seconds(1)), LoginGuard::longest_delay);
  EXPECT_EQ(delay(max_, start + 2 * LoginGuard::memory), seconds(0));
}

TEST_F(LoginGuardTest, AttemptsAtTheSameTimeCountBeforeTheyAreJudged) {
  std::vector<std::optional<Attempt>> underway;
  for (const int expected : {0, 0, 0, 1}) {
    underway.push_back(begin(max_));
    ASSERT_TRUE(underway.back());
    EXPECT_EQ(underway.back()->delay(), seconds(expected));
  }
}

TEST_F(LoginGuardTest, WhatCouldNotBeJudgedDoesNotCount) {
  for (int i = 0; i < 50; ++i) {
    EXPECT_EQ(begin(max_)->delay(), seconds(0));
  }
}

TEST_F(LoginGuardTest, FewAttemptsOfAPairAndOfAnAddressAreUnderWayAtTheSameTime) {
  std::vector<std::optional<Attempt>> underway;
  for (std::size_t i = 0; i < LoginGuard::pair_places; ++i) {
    underway.push_back(begin(max_));
  }
  EXPECT_FALSE(begin(max_));
  while (underway.size() < LoginGuard::address_places) {
    underway.push_back(begin({"10.0.0.1", "user" + std::to_string(underway.size()), ""}));
    ASSERT_TRUE(underway.back());
  }
  EXPECT_FALSE(begin({"10.0.0.1", "another", ""}));
  EXPECT_TRUE(begin({"10.0.0.2", "max", ""}));
  underway.clear();
  EXPECT_TRUE(begin(max_));
}

TEST_F(LoginGuardTest, AFloodFromTheSameAddressDoesNotKeepOutABrowserThatIsKnown) {
  guard_.know("token", "max", start);
  try_wrong(max_, 100);
  std::vector<std::optional<Attempt>> flood;
  for (std::size_t i = 0; i < LoginGuard::address_places; ++i) {
    flood.push_back(begin({"10.0.0.1", i % 2 == 0 ? "max" : "user" + std::to_string(i), ""}));
  }
  EXPECT_FALSE(begin(max_));
  EXPECT_EQ(delay({"10.0.0.1", "max", "token"}), seconds(0));
}

TEST_F(LoginGuardTest, ABrowserIsKnownForItsUserAloneAndForFewGuesses) {
  guard_.know("token", "max", start);
  try_wrong({"10.0.0.1", "eve", ""}, 3);
  EXPECT_EQ(delay({"10.0.0.1", "eve", "token"}), seconds(1));
  try_wrong({"10.0.0.1", "max", "token"}, LoginGuard::free_attempts_of_browser);
  EXPECT_EQ(delay(max_), seconds(0)) << "they were the browser's";
  try_wrong({"10.0.0.1", "max", "token"}, 3);
  EXPECT_EQ(delay(max_), seconds(1)) << "they are the address' by now";
}

TEST_F(LoginGuardTest, ManyPairsForgetTheOldestAndNoneThatIsUnderWay) {
  try_wrong(max_, 3);
  const auto underway = begin({"10.0.0.9", "max", ""});
  for (std::size_t i = 0; i < LoginGuard::capacity; ++i) {
    const std::string number = std::to_string(i);
    try_wrong({"10.1.0." + number, "user" + number, ""}, 1, start + seconds(1));
  }
  EXPECT_EQ(delay(max_), seconds(0));
}

TEST_F(LoginGuardTest, AnAttemptMayOutliveItsGuard) {
  auto guard = std::make_unique<LoginGuard>();
  auto attempt = guard->begin(max_, start);
  guard.reset();
  attempt->judged(false);
}

}  // namespace
}  // namespace interlock::web
