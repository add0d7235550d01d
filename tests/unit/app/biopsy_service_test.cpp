#include "service/biopsy_service.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "robot_fixture.hpp"

namespace interlock::web {
namespace {

using nlohmann::json;
using test::needle_view;
using test::prostate;
using testing::HasSubstr;

constexpr std::array<double, 3> ahead_mm{3.0, -2.0, 70.0};

/** Of the membranes, in their order. */
std::vector<std::string> states(const json& shown) {
  std::vector<std::string> found;
  for (const json& membrane : shown["membranes"]) {
    found.push_back(membrane["state"]);
  }
  return found;
}

class BiopsyServiceTest : public testing::Test {
 protected:
  [[nodiscard]] json shown(const ControlView& view = needle_view()) const {
    return desk_.to_json(view, false);
  }

  /** What a control thread tells that has passed these membranes; below 0: skipped. */
  static ControlView passed(std::uint32_t proposal, const std::vector<double>& found_mm) {
    ControlView view = needle_view();
    view.biopsy.task = proposal;
    view.biopsy.membranes = static_cast<std::uint32_t>(found_mm.size());
    std::copy(found_mm.begin(), found_mm.end(), view.biopsy.found_mm.begin());
    return view;
  }

  BiopsyService desk_{prostate()};
};

TEST_F(BiopsyServiceTest, StartsWithTheMembranesAndZeroesOfTheRobotFile) {
  EXPECT_EQ(states(shown()), (std::vector<std::string>{"next", "expected"}));
  EXPECT_EQ(shown()["membranes"][1]["depth_mm"], 50.0);
  EXPECT_EQ(shown()["left"], 2);
  EXPECT_EQ(shown()["hand"]["zero_counts"], 1970.0);
  EXPECT_EQ(shown()["needle"]["zero_counts"], 1780.0);
}

TEST_F(BiopsyServiceTest, AForceThatWasNeverReadIsNotShownAsZero) {
  ControlView view = needle_view();
  view.force.count = 0;
  EXPECT_TRUE(shown(view)["hand"]["force_n"].is_null());
  EXPECT_TRUE(shown(view)["force_age_ms"].is_null());
  view = needle_view();
  view.attached = false;
  EXPECT_TRUE(shown(view)["needle"]["raw_counts"].is_null());
}

TEST_F(BiopsyServiceTest, ForcesAreShownRawCalibratedAndWithTheirAge) {
  ControlView view = needle_view(1970 + 452, 1780);
  view.snapshot.state.system.tick += 7;
  EXPECT_EQ(shown(view)["hand"]["raw_counts"], 2422);
  EXPECT_NEAR(shown(view)["hand"]["force_n"].get<double>(), 4.0, 0.01);
  EXPECT_EQ(shown(view)["force_age_ms"], 7.0);
}

TEST_F(BiopsyServiceTest, ADraftIsOfTheTickOfItsViewAndOfItsAuthor) {
  const auto draft = desk_.draft(ahead_mm, needle_view(), "edna");
  ASSERT_TRUE(draft) << draft.error().detail;
  EXPECT_EQ(draft->work.as<BiopsyTask>().start_tick, 1000u);
  EXPECT_EQ(draft->author, "edna");
  EXPECT_EQ(draft->work.as<BiopsyTask>().run->entry_mm, 20.0);
  EXPECT_EQ(draft->targeting_revision, std::nullopt);
}

TEST_F(BiopsyServiceTest, ATargetThatIsNotAheadIsInvalid) {
  for (const std::array<double, 3>& target :
       {std::array{0.0, 0.0, 0.0}, std::array{1.0, 0.0, -5.0}, std::array{0.0, 0.0, std::nan("")}}) {
    const auto draft = desk_.draft(target, needle_view(), "edna");
    ASSERT_FALSE(draft);
    EXPECT_EQ(draft.error().code, "INVALID");
    EXPECT_EQ(draft.error().field, "target_mm");
  }
}

TEST_F(BiopsyServiceTest, MembranesThatABiopsyPassedStayPassedForTheNextOne) {
  desk_.begin(4);
  desk_.follow(passed(4, {24.6}));
  EXPECT_EQ(states(shown()), (std::vector<std::string>{"passed", "next"}));
  EXPECT_EQ(shown()["membranes"][0]["found_mm"], 24.6);
  desk_.begin(5);
  desk_.follow(passed(5, {-1.0}));
  EXPECT_EQ(states(shown()), (std::vector<std::string>{"passed", "passed"}));
  EXPECT_EQ(shown()["membranes"][0]["found_mm"], 24.6);
  EXPECT_TRUE(shown()["membranes"][1]["found_mm"].is_null()) << "it was skipped";
  EXPECT_EQ(shown()["left"], 0);
}

TEST_F(BiopsyServiceTest, WhatAnotherBiopsyPassedCountsForNothing) {
  desk_.follow(passed(4, {24.6}));
  desk_.begin(5);
  desk_.follow(passed(4, {24.6}));
  EXPECT_EQ(states(shown()), (std::vector<std::string>{"next", "expected"}));
}

TEST_F(BiopsyServiceTest, ASetListForgetsWhatWasFoundAndIsNotFollowedByTheBiopsyBefore) {
  desk_.begin(4);
  desk_.follow(passed(4, {24.6, 51.0}));
  desk_.set({{10.0, 20.0}, 0});
  desk_.follow(passed(4, {24.6, 51.0}));
  EXPECT_EQ(states(shown()), (std::vector<std::string>{"next", "expected"}));
  desk_.begin(5);
  desk_.follow(passed(5, {9.0}));
  desk_.reset();
  EXPECT_EQ(states(shown()), (std::vector<std::string>{"next", "expected"}));
  EXPECT_EQ(shown()["membranes"][0]["depth_mm"], 10.0);
  EXPECT_TRUE(shown()["membranes"][0]["found_mm"].is_null());
}

TEST_F(BiopsyServiceTest, ZeroingTakesTheMeanOfTheReadingsOfBoth) {
  ASSERT_TRUE(desk_.zero(needle_view(2000, 1750)));
  EXPECT_EQ(shown()["hand"]["zero_counts"], 2000.0);
  EXPECT_EQ(shown()["needle"]["zero_counts"], 1750.0);
  EXPECT_NEAR(shown(needle_view(2000, 1750))["hand"]["force_n"].get<double>(), 0.0, 1e-12);
}

TEST_F(BiopsyServiceTest, AForceThatIsNoRestIsNotZeroedAndTheOtherOneIsNotEither) {
  ControlView trembling = needle_view(2000, 1780);
  for (std::size_t each = 0; each < ForceReadings::kept; each += 2) {
    trembling.force.last_needle[each] += 60;
  }
  ControlView fresh = needle_view(2000, 1750);
  fresh.force.count = 20;
  const std::pair<ControlView, const char*> cases[] = {
      {trembling, "needle"}, {needle_view(1970 + 700, 1780), "hand"}, {fresh, "hand"}};
  for (const auto& [view, force] : cases) {
    const auto zeroed = desk_.zero(view);
    ASSERT_FALSE(zeroed) << force;
    EXPECT_EQ(zeroed.error().code, "ZEROING");
    EXPECT_THAT(zeroed.error().detail, HasSubstr(force));
    EXPECT_EQ(shown()["hand"]["zero_counts"], 1970.0);
  }
}

TEST(BiopsyService, OfARobotWithoutANeedleRefusesEverything) {
  BiopsyService desk(test::neuro());
  EXPECT_FALSE(desk.has_needle());
  EXPECT_EQ(desk.zero(test::ready_view()).error().code, "NOT_FOUND");
  EXPECT_EQ(desk.draft(ahead_mm, test::ready_view(), "edna").error().code, "NOT_FOUND");
}

}  // namespace
}  // namespace interlock::web
