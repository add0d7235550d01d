#include "store/runs.hpp"

#include "store/cases.hpp"
#include "store_fixture.hpp"

namespace interlock {
namespace {

using nlohmann::json;

class RunsTest : public StoreTest {
 protected:
  static KeptRun run(std::int64_t number, UtcTime begun = noon, const std::string& outcome = "done") {
    return {.number = number,
            .case_number = 0,
            .kind = "move",
            .axes = {"lateral"},
            .outcome = outcome,
            .begun = begun,
            .note = {},
            .value = {{"detail", "At rest."}}};
  }

  std::vector<std::int64_t> numbers(const RunFilter& filter = {.count = 1000}) {
    std::vector<std::int64_t> found;
    for (const KeptRun& each :
         seen(store_, [&](Transaction& transaction) { return Runs(transaction).list(filter); })) {
      found.push_back(each.number);
    }
    return found;
  }

  Store store_ = open();
};

TEST_F(RunsTest, ARunIsThereAfterReopeningWithItsNewestSamples) {
  commit(store_, [](Transaction& transaction) {
    Runs(transaction).keep(run(7, noon, run_goes_on), {{"ticks", {0}}});
    Runs(transaction).keep(run(7), {{"ticks", {0, 33}}});
  });
  Store again = open();
  const auto found = seen(again, [](Transaction& transaction) { return Runs(transaction).find(7); });
  ASSERT_TRUE(found);
  EXPECT_EQ(found->outcome, "done");
  EXPECT_EQ(found->axes, std::vector<std::string>{"lateral"});
  EXPECT_EQ(found->begun, noon);
  EXPECT_EQ(seen(again, [](Transaction& transaction) { return Runs(transaction).samples(7); }),
            (json{{"ticks", {0, 33}}}));
  EXPECT_EQ(seen(again, [](Transaction& transaction) { return Runs(transaction).newest(); }), 7);
}

TEST_F(RunsTest, OnlyRunsThatWentOnAreInterrupted) {
  commit(store_, [](Transaction& transaction) {
    Runs runs(transaction);
    runs.keep(run(1), json::object());
    runs.keep(run(2, noon, run_goes_on), json::object());
    EXPECT_EQ(runs.interrupt("The app ended."), std::vector<std::int64_t>{2});
    EXPECT_EQ(runs.find(1)->value["detail"], "At rest.");
    EXPECT_EQ(runs.find(2)->outcome, run_interrupted);
    EXPECT_EQ(runs.find(2)->value["detail"], "The app ended.");
    EXPECT_TRUE(runs.interrupt("again").empty());
  });
}

TEST_F(RunsTest, ANoteStaysWhenTheRunIsKeptAgainAndGoesWithItsCase) {
  commit(store_, [](Transaction& transaction) {
    Runs runs(transaction);
    KeptRun of_a_case = run(1);
    of_a_case.case_number = Cases(transaction).add({{"label", "a"}});
    runs.keep(of_a_case, json::object());
    EXPECT_TRUE(runs.annotate(1, "stiff"));
    EXPECT_FALSE(runs.annotate(2, "no such run"));
    runs.keep(of_a_case, json::object());
    EXPECT_EQ(runs.find(1)->note, "stiff");
    Cases(transaction).remove(of_a_case.case_number);
    EXPECT_EQ(runs.find(1)->note, "");
  });
}

TEST_F(RunsTest, RetentionByCountRemovesTheOldestAndNoneThatGoesOn) {
  commit(store_, [](Transaction& transaction) {
    Runs runs(transaction);
    runs.keep(run(1, noon, run_goes_on), json::object());
    for (std::int64_t number = 2; number <= 40; ++number) {
      runs.keep(run(number), json::object());
    }
    runs.set_retention({.count = 30, .days = 10}, noon);
    runs.prune(noon);
  });
  std::vector<std::int64_t> expected;
  for (std::int64_t number = 40; number > 10; --number) {
    expected.push_back(number);
  }
  expected.push_back(1);
  EXPECT_EQ(numbers(), expected);
}

TEST_F(RunsTest, RetentionByDaysLeavesTheNewestHoweverFarTheClockJumps) {
  commit(store_, [](Transaction& transaction) {
    Runs runs(transaction);
    for (std::int64_t number = 1; number <= 30; ++number) {
      runs.keep(run(number), json::object());
    }
    runs.prune(noon + std::chrono::hours(24) * 364);
    EXPECT_EQ(runs.list({.count = 1000}).size(), 30u) << "within the 365 days of the default";
    runs.prune(noon + std::chrono::hours(24) * 366);
  });
  EXPECT_EQ(numbers().size(), static_cast<std::size_t>(RunRetention::always));
  EXPECT_EQ(numbers().front(), 30);
}

}  // namespace
}  // namespace interlock
