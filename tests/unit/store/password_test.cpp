#include "store/password.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <set>
#include <string>

namespace interlock {
namespace {

using testing::StartsWith;
using Match = PasswordHash::Match;

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
  EXPECT_EQ(hash->compare(Password("correct horse")), Match::right);
  EXPECT_EQ(hash->compare(Password("correct horsf")), Match::wrong);
  EXPECT_EQ(hash->compare(Password("")), Match::wrong);
}

TEST(Password, SamePasswordHasAnotherHashEachTime) {
  EXPECT_NE(hash_of("correct horse")->text(), hash_of("correct horse")->text());
}

/** Characters that follow no rule. */
std::string unguessable(std::size_t length) {
  constexpr std::string_view letters = "kx7vq2mzt9";
  std::string text;
  for (std::size_t i = 0; text.size() < length; ++i) {
    text += letters[(i * i + i / letters.size()) % letters.size()];
  }
  return text;
}

TEST(Password, HasTenToOneHundredAndTwentyEightCharacters) {
  expect_refused(unguessable(9));
  expect_refused(unguessable(129));
  expect_refused("");
  EXPECT_TRUE(hash_of(unguessable(10)));
  EXPECT_TRUE(hash_of(unguessable(128)));
}

TEST(Password, LengthCountsCharactersNotBytes) {
  expect_refused("k\xc3\xbcx7vq2mz");
  EXPECT_TRUE(hash_of("k\xc3\xbcx7vq2mzt"));
}

TEST(Password, ThatIsEasyToGuessIsRefused) {
  for (const char* const guess :
       {"aaaaaaaaaa", "1234567890", "0987654321", "qwertyuiop", "qwertzuiop", "abcdefghijkl", "password12",
        "Password123!", "passwortpasswort", "hospital2024", "abcabcabcabcabc", "1212121212", "qwerty12345",
        "iloveyou1234", "interlock123"}) {
    expect_refused(guess);
  }
}

TEST(Password, ThatIsTheNameOfItsUserIsRefusedHoweverOftenItIsRepeated) {
  for (const char* const guess :
       {"maximiliane", "MaximilianeMaximiliane", "maximiliane12", "maximiliane1990"}) {
    expect_refused(guess, "maximiliane");
  }
  expect_refused("annannannann");
}

TEST(Password, OfAFewUnexpectedWordsIsTaken) {
  for (const char* const text :
       {"correct horse", "a much better one", "my password is good", "tr0ub4dor&3x"}) {
    EXPECT_TRUE(hash_of(text)) << text;
  }
}

#ifndef __SANITIZE_ADDRESS__
/** Runs `work` in a process of its own that gets no more memory; its result is the exit code. */
template <typename Work>
int without_memory(Work work) {
  const pid_t child = fork();
  if (child == 0) {
    const rlimit nothing{32u << 20u, 32u << 20u};
    setrlimit(RLIMIT_AS, &nothing);
    _exit(work());
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(Password, IsNotWrongWhenThereIsNoMemoryToCompareIt) {
  const auto hash = hash_of("correct horse");
  ASSERT_TRUE(hash);
  EXPECT_EQ(without_memory([&] { return static_cast<int>(hash->compare(Password("correct horse"))); }),
            static_cast<int>(Match::no_memory));
}

TEST(Password, IsNotRefusedAsInvalidWhenThereIsNoMemoryToHashIt) {
  EXPECT_EQ(without_memory([] {
              const auto hash = hash_of("correct horse");
              return hash ? -1 : static_cast<int>(hash.error().kind);
            }),
            static_cast<int>(StoreError::Kind::no_memory));
}
#endif

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
  EXPECT_EQ(PasswordHash("").compare(Password("")), Match::wrong);
  EXPECT_EQ(PasswordHash("$argon2id$nonsense").compare(Password("correct horse")), Match::wrong);
}

}  // namespace
}  // namespace interlock
