#include "store/password.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

namespace interlock {
namespace {

using testing::StartsWith;

Stored<PasswordHash> hash_of(std::string text, const std::string& user = "ann") {
  return PasswordHash::of_new(Password(std::move(text)), user);
}

void expect_refused(const std::string& text, const std::string& user = "ann") {
  const auto hash = hash_of(text, user);
  ASSERT_FALSE(hash) << text;
  EXPECT_EQ(hash.error().kind, StoreError::Kind::invalid);
  EXPECT_EQ(hash.error().field, "password");
  EXPECT_FALSE(hash.error().expected.empty());
}

TEST(Password, IsKeptAsArgon2idOfAtLeastTheInteractiveCost) {
  const auto hash = hash_of("correct horse");
  ASSERT_TRUE(hash);
  EXPECT_THAT(hash->text(), StartsWith("$argon2id$v=19$m=65536,t=2,p=1$"));
  EXPECT_TRUE(hash->matches(Password("correct horse")));
  EXPECT_FALSE(hash->matches(Password("correct horsf")));
  EXPECT_FALSE(hash->matches(Password("")));
}

TEST(Password, SamePasswordHasAnotherHashEachTime) {
  EXPECT_NE(hash_of("correct horse")->text(), hash_of("correct horse")->text());
}

TEST(Password, HasTenToOneHundredAndTwentyEightCharacters) {
  expect_refused(std::string(9, 'x'));
  expect_refused(std::string(129, 'x'));
  expect_refused("");
  EXPECT_TRUE(hash_of(std::string(10, 'x')));
  EXPECT_TRUE(hash_of(std::string(128, 'x')));
}

TEST(Password, LengthCountsCharactersNotBytes) {
  const std::string umlaut = "\xc3\xbc";
  std::string nine;
  for (int count = 0; count < 9; ++count) {
    nine += umlaut;
  }
  expect_refused(nine);
  EXPECT_TRUE(hash_of(nine + umlaut));
}

TEST(Password, IsUtf8) {
  for (const char* const broken : {"\xff", "\xc3", "\xe2\x82", "\xc0\xaf", "\x80"}) {
    expect_refused("ten characters " + std::string(broken));
  }
}

TEST(Password, IsNotTheNameOfItsUser) {
  expect_refused("maximiliane", "maximiliane");
  EXPECT_TRUE(hash_of("maximiliane", "ann"));
}

TEST(Password, OverwritesWhereItCameFrom) {
  std::string text = "correct horse";
  const char* const memory = text.data();
  const Password password(std::move(text));
  EXPECT_EQ(std::string(memory, 13), std::string(13, '\0'));
  EXPECT_EQ(password.text(), "correct horse");
}

TEST(Password, RandomOnesDifferAndKeepTheRules) {
  std::set<std::string> seen;
  for (int count = 0; count < 100; ++count) {
    const auto password = Password::random();
    ASSERT_TRUE(password);
    EXPECT_EQ(password->text().size(), 20u);
    EXPECT_EQ(password->text().find_first_of("ilo01 "), std::string_view::npos);
    seen.emplace(password->text());
  }
  EXPECT_EQ(seen.size(), 100u);
  EXPECT_TRUE(hash_of(std::string(*seen.begin())));
}

TEST(Password, ForgedHashMatchesNothing) {
  EXPECT_FALSE(PasswordHash("").matches(Password("")));
  EXPECT_FALSE(PasswordHash("$argon2id$nonsense").matches(Password("correct horse")));
}

}  // namespace
}  // namespace interlock
