#include "http/login_guard.hpp"

#include <gtest/gtest.h>

namespace interlock::web {
namespace {

using std::chrono::seconds;

constexpr SteadyTime start{};

class LoginGuardTest : public testing::Test {
 protected:
  void try_wrong(const std::string& name, SteadyTime now) {
    guard_.begin(name, now);
    guard_.end(name, false);
  }

  LoginGuard guard_;
};

TEST_F(LoginGuardTest, TheWaitDoublesFromOneSecondToSixty) {
  SteadyTime now = start;
  for (const int expected : {0, 0, 1, 2, 4, 8, 16, 32, 60, 60}) {
    try_wrong("max", now);
    EXPECT_EQ(guard_.wait("max", now), seconds(expected));
    now += seconds(expected);
    EXPECT_EQ(guard_.wait("max", now), seconds(0));
  }
}

TEST_F(LoginGuardTest, OtherNamesDoNotWait) {
  for (int i = 0; i < 5; ++i) {
    try_wrong("max", start);
  }
  EXPECT_EQ(guard_.wait("eve", start), seconds(0));
}

TEST_F(LoginGuardTest, ASuccessEndsTheWaiting) {
  try_wrong("max", start);
  try_wrong("max", start);
  guard_.begin("max", start);
  guard_.end("max", true);
  try_wrong("max", start);
  EXPECT_EQ(guard_.wait("max", start), seconds(0));
}

TEST_F(LoginGuardTest, AttemptsAtTheSameTimeCountBeforeTheyAreJudged) {
  for (int i = 0; i < 3; ++i) {
    guard_.begin("max", start);
  }
  EXPECT_EQ(guard_.wait("max", start), seconds(1));
}

TEST_F(LoginGuardTest, WhatCouldNotBeJudgedDoesNotCount) {
  for (int i = 0; i < 5; ++i) {
    guard_.begin("max", start);
    guard_.end_unjudged("max");
  }
  EXPECT_EQ(guard_.wait("max", start), seconds(0));
}

TEST_F(LoginGuardTest, ManyOtherNamesAtTheSameTimeLockNobodyOut) {
  for (int i = 0; i < 100; ++i) {
    guard_.begin("user" + std::to_string(i), start);
  }
  EXPECT_EQ(guard_.wait("another", start), seconds(0));
}

TEST_F(LoginGuardTest, ManyNamesForgetTheOldest) {
  for (int i = 0; i < 4; ++i) {
    try_wrong("max", start);
  }
  for (std::size_t i = 0; i < LoginGuard::capacity; ++i) {
    try_wrong("user" + std::to_string(i), start + seconds(1));
  }
  EXPECT_EQ(guard_.wait("max", start), seconds(0));
}

}  // namespace
}  // namespace interlock::web
