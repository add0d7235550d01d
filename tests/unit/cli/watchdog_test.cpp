#include "cli/watchdog.hpp"

#include <gmock/gmock.h>

namespace interlock::cli {
namespace {

using namespace std::chrono_literals;

TEST(Watchdog, expires_after_its_limit) {
  const Watchdog::Time start{};
  Watchdog watchdog(5s, start);
  for (auto look = 1s; look < 5s; look += 1s) {
    EXPECT_FALSE(watchdog.has_expired(start + look));
    EXPECT_EQ(watchdog.next_look(), start + look + 1s);
  }
  EXPECT_TRUE(watchdog.has_expired(start + 5s));
}

TEST(Watchdog, begins_anew_after_a_sign_of_life) {
  const Watchdog::Time start{};
  Watchdog watchdog(5s, start);
  for (auto look = 1s; look < 5s; look += 1s) {
    ASSERT_FALSE(watchdog.has_expired(start + look));
  }
  watchdog.feed();
  for (auto look = 5s; look < 9s; look += 1s) {
    EXPECT_FALSE(watchdog.has_expired(start + look));
  }
  EXPECT_TRUE(watchdog.has_expired(start + 9s));
}

TEST(Watchdog, a_machine_that_stood_still_for_an_hour_makes_no_program_a_silent_one) {
  const Watchdog::Time start{};
  Watchdog watchdog(5s, start);
  EXPECT_FALSE(watchdog.has_expired(start + 1h));
  EXPECT_FALSE(watchdog.has_expired(start + 2h));
  EXPECT_EQ(watchdog.next_look(), start + 2h + 1s);
}

}  // namespace
}  // namespace interlock::cli
