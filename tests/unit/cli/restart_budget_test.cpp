#include "cli/restart_budget.hpp"

#include <gmock/gmock.h>

namespace interlock::cli {
namespace {

using namespace std::chrono_literals;

TEST(RestartBudget, allows_five_within_a_minute_and_no_sixth) {
  RestartBudget budget(5, 60s);
  const RestartBudget::Time start{};
  for (int restart = 0; restart < 5; ++restart) {
    EXPECT_TRUE(budget.spend(start + restart * 1s));
  }
  EXPECT_FALSE(budget.spend(start + 59999ms));
}

TEST(RestartBudget, allows_one_more_when_the_first_is_a_minute_old) {
  RestartBudget budget(5, 60s);
  const RestartBudget::Time start{};
  for (int restart = 0; restart < 5; ++restart) {
    ASSERT_TRUE(budget.spend(start + restart * 1s));
  }
  EXPECT_TRUE(budget.spend(start + 60s));
  EXPECT_FALSE(budget.spend(start + 60s));
  EXPECT_EQ(budget.spent(), 5u);
}

TEST(RestartBudget, a_refused_restart_is_not_counted) {
  RestartBudget budget(1, 60s);
  const RestartBudget::Time start{};
  ASSERT_TRUE(budget.spend(start));
  ASSERT_FALSE(budget.spend(start + 59s));
  EXPECT_TRUE(budget.spend(start + 60s));
}

}  // namespace
}  // namespace interlock::cli
