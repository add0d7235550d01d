#include "service/targeting.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "project_robots.hpp"

namespace interlock::web {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

/** Turned by an angle about the third axis. */
RowMajor turned(double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {c, -s, 0, 10, s, c, 0, -20, 0, 0, 1, 30.5, 0, 0, 0, 1};
}

tl::expected<Targeting, Problem> registered(const json& pose) {
  return with_registration({}, {{"registration", pose}});
}

TEST(Targeting, StartsWithNothingSet) {
  const json body = to_json(judged({}, {7}));
  EXPECT_TRUE(body["registration"].is_null());
  EXPECT_EQ(body["registration_state"], "not_set");
  EXPECT_TRUE(body["entry_point"].is_null());
  EXPECT_TRUE(body["target_point"].is_null());
  EXPECT_TRUE(body["reported_position"].is_null());
  EXPECT_EQ(body["cannula_to_treatment_offset"], 0.0);
}

TEST(Targeting, ARegistrationIsKeptAsGiven) {
  const auto set = registered(turned(0.7));
  ASSERT_TRUE(set);
  EXPECT_EQ(set->registration, turned(0.7));
  EXPECT_FALSE(set->ignore_registration_rotation);
}

TEST(Targeting, NumericStringsAreNumbers) {
  json pose = turned(0);
  for (json& each : pose) {
    each = each.dump();
  }
  const auto set = registered(pose);
  ASSERT_TRUE(set);
  EXPECT_EQ(set->registration, turned(0));
  const auto target =
      with_target({}, {{"entry_point", {"1.5", -2, "3e1"}}, {"robot_to_entry_offset", "-7.25"}});
  ASSERT_TRUE(target);
  EXPECT_THAT(*target->entry_point, ElementsAre(1.5, -2.0, 30.0));
  EXPECT_EQ(target->robot_to_entry_mm, -7.25);
}

TEST(Targeting, AnElementThatIsNoNumberIsNamed) {
  json pose = turned(0);
  pose[6] = "1 mm";
  EXPECT_EQ(registered(pose).error().field, "registration[6]");
  pose[6] = nullptr;
  EXPECT_EQ(registered(pose).error().field, "registration[6]");
  pose.erase(6);
  EXPECT_EQ(registered(pose).error().field, "registration");
  EXPECT_EQ(registered(7).error().field, "registration");
  EXPECT_EQ(with_registration({}, json::object()).error().field, "registration");
}

TEST(Targeting, OnlyARigidPoseIsARegistration) {
  RowMajor scaled = turned(0.3);
  scaled[0] *= 1.01;
  EXPECT_THAT(registered(scaled).error().detail, HasSubstr("length"));
  RowMajor skewed = turned(0);
  skewed[1] = 0.01;
  EXPECT_THAT(registered(skewed).error().detail, HasSubstr("perpendicular"));
  RowMajor mirrored = turned(0);
  mirrored[10] = -1;
  EXPECT_THAT(registered(mirrored).error().expected, HasSubstr("determinant"));
  EXPECT_FALSE(registered(RowMajor{}));
}

TEST(Targeting, ARotationMayBeRoundedToThreeDigits) {
  RowMajor rounded = turned(0.5);
  for (double& each : rounded) {
    each = std::round(each * 1e4) / 1e4;
  }
  EXPECT_TRUE(registered(rounded));
}

TEST(Targeting, TheLastRowOfAPoseIsFixed) {
  for (std::size_t column = 0; column < 4; ++column) {
    RowMajor pose = turned(0);
    pose[12 + column] += 0.5;
    EXPECT_EQ(registered(pose).error().field, "registration[" + std::to_string(12 + column) + "]");
  }
}

TEST(Targeting, HugeNumbersAreRefusedNotOverflown) {
  RowMajor pose = turned(0);
  pose[0] = 1e308;
  pose[4] = 1e308;
  EXPECT_FALSE(registered(pose));
  RowMajor away = turned(0);
  away[7] = 10000.5;
  EXPECT_EQ(registered(away).error().field, "registration[7]");
}

TEST(Targeting, PointsHaveABound) {
  EXPECT_TRUE(with_target({}, {{"target_point", {10000, -10000, 0}}}));
  const auto refused = with_target({}, {{"target_point", {0, -10000.1, 0}}});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().field, "target_point[1]");
  EXPECT_FALSE(with_target({}, {{"target_point", {0, 0}}}));
  EXPECT_FALSE(with_target({}, {{"target_point", nullptr}}));
}

TEST(Targeting, OffsetsHaveABound) {
  const auto set =
      with_target({}, {{"treatment_to_tip_offset", 1000}, {"treatment_to_robot_at_home", "-1000"}});
  ASSERT_TRUE(set);
  EXPECT_EQ(set->treatment_to_tip_mm, 1000.0);
  EXPECT_EQ(set->treatment_to_robot_at_home_mm, -1000.0);
  EXPECT_EQ(with_target({}, {{"robot_to_entry_offset", 1000.5}}).error().field, "robot_to_entry_offset");
}

TEST(Targeting, BothSpellingsOfTheCannulaAreOneValue) {
  for (const char* name : {"cannula_to_treatment_offset", "canula_to_treatment_offset"}) {
    const auto set = with_target({}, {{name, 12.5}});
    ASSERT_TRUE(set) << name;
    EXPECT_EQ(to_json(*set)["cannula_to_treatment_offset"], 12.5);
    EXPECT_EQ(to_json(*set)["canula_to_treatment_offset"], 12.5);
  }
  const json both{{"cannula_to_treatment_offset", 1}, {"canula_to_treatment_offset", 1}};
  EXPECT_EQ(with_target({}, both).error().field, "canula_to_treatment_offset");
}

TEST(Targeting, FieldsLeftOutStay) {
  Targeting before;
  before.entry_point = Point{1, 2, 3};
  before.robot_to_entry_mm = 4;
  const auto set = with_target(before, {{"target_point", {7, 8, 9}}});
  ASSERT_TRUE(set);
  EXPECT_EQ(set->entry_point, before.entry_point);
  EXPECT_EQ(set->robot_to_entry_mm, 4);
  EXPECT_EQ(with_target(before, json::object()).value(), before);
}

TEST(Targeting, ARegistrationIsValidInTheEpochInWhichItWasSetAndInNoOther) {
  const InForce epoch{7};
  const auto set = with_registration(judged({}, epoch), {{"registration", turned(0.1)}});
  ASSERT_TRUE(set);
  EXPECT_EQ(to_json(judged(*set, epoch))["registration_state"], "valid");
  EXPECT_EQ(judged(*set, epoch).registration_problem, "");
  const json expired = to_json(judged(*set, {8, "The table moved."}));
  EXPECT_EQ(expired["registration_state"], "expired");
  EXPECT_EQ(expired["registration_problem"], "The registration has expired: The table moved.");
  EXPECT_EQ(expired["registration"], json(turned(0.1))) << "it is still told";
  EXPECT_EQ(to_json(*with_registration({}, {{"registration", turned(0)}}))["registration_state"], "expired")
      << "in no epoch";
}

TEST(Targeting, TheTurnOfARegistrationIsIgnoredOnlyWhereItSaysSo) {
  const auto ignoring =
      with_registration({}, {{"registration", turned(0.1)}, {"ignore_registration_rotation", true}});
  ASSERT_TRUE(ignoring);
  EXPECT_TRUE(ignoring->ignore_registration_rotation);
  EXPECT_FALSE(with_registration(*ignoring, {{"registration", turned(0.2)}})->ignore_registration_rotation);
}

TEST(Targeting, HowWellARegistrationFitsIsKeptWithItAndGoesWithIt) {
  const json fitted{{"registration", turned(0.1)}, {"residual_mm", 0.4}, {"fiducials", 7}};
  const Targeting set = stored_targeting(to_stored(*with_registration({}, fitted))).value();
  EXPECT_EQ(to_json(set)["residual_mm"], 0.4);
  EXPECT_EQ(to_json(set)["fiducials"], 7);
  const json replaced = to_json(*with_registration(set, {{"registration", turned(0.2)}}));
  EXPECT_TRUE(replaced["residual_mm"].is_null());
  EXPECT_TRUE(replaced["fiducials"].is_null());
}

const json three_fiducials = {{0, 0, 0}, {50, 0, 0}, {0, 50, 10}};

TEST(Targeting, TheFiducialsOfARegistrationAreKeptAndCountedAndGoWithIt) {
  const json fitted{
      {"registration", turned(0.1)}, {"residual_mm", 0.4}, {"fiducial_points", three_fiducials}};
  const Targeting set = stored_targeting(to_stored(*with_registration({}, fitted))).value();
  EXPECT_EQ(to_json(set)["fiducial_points"], three_fiducials);
  EXPECT_EQ(to_json(set)["fiducials"], 3);
  const json replaced = to_json(*with_registration(set, {{"registration", turned(0.2)}}));
  EXPECT_EQ(replaced["fiducial_points"], json::array());
}

TEST(Targeting, ACovarianceBelongsToTheTargetPointThatItCameWith) {
  const json covariance{0.04, 0.01, 0, 0.01, 0.09, 0, 0, 0, 0.16};
  const Targeting set =
      *with_target({}, {{"target_point", {1, 2, 3}}, {"target_covariance_mm2", covariance}});
  EXPECT_EQ(to_json(stored_targeting(to_stored(set)).value())["target_covariance_mm2"], covariance);
  EXPECT_FALSE(with_target(set, {{"target_point", {1, 2, 4}}})->target_covariance_mm2);
  EXPECT_TRUE(with_target(set, {{"entry_point", {1, 2, 4}}})->target_covariance_mm2);
  EXPECT_FALSE(without_target(set, json::object())->target_covariance_mm2);
}

TEST(Targeting, WhatIsNoCovarianceIsRefused) {
  const json wrong[] = {{1, 0.5, 0, 0, 1, 0, 0, 0, 1},
                        {1, 2, 0, 2, 1, 0, 0, 0, 1},
                        {-1, 0, 0, 0, 1, 0, 0, 0, 1},
                        {20000, 0, 0, 0, 1, 0, 0, 0, 1},
                        {1, 0, 0, 0, 1, 0, 0, 0}};
  for (const json& each : wrong) {
    const auto set = with_target({}, {{"target_point", {1, 2, 3}}, {"target_covariance_mm2", each}});
    ASSERT_FALSE(set) << each;
    EXPECT_EQ(set.error().field, "target_covariance_mm2");
  }
  const json identity{1, 0, 0, 0, 1, 0, 0, 0, 1};
  EXPECT_EQ(with_target({}, {{"target_covariance_mm2", identity}}).error().field, "target_point");
}

json planned(const json& list) { return {{"planned_targets", list}}; }

const json first_core{{"name", "core 1"}, {"entry_point", {1, 2, 3}}, {"target_point", {4, 5, 6.5}}};

TEST(Targeting, PlannedTargetsAreKeptInTheirOrderAndReplaceNoTarget) {
  json second = first_core;
  second["name"] = "core 2";
  const json list{second, first_core};
  const Targeting set = stored_targeting(to_stored(*with_planned_targets({}, planned(list)))).value();
  EXPECT_EQ(to_json(set)["planned_targets"], list);
  EXPECT_TRUE(to_json(set)["target_point"].is_null());
  EXPECT_EQ(to_json(*with_planned_targets(set, planned(json::array())))["planned_targets"], json::array());
}

TEST(Targeting, APlannedTargetThatIsWrongIsNamed) {
  const auto with = [](const char* name, const json& value) {
    json target = first_core;
    target[name] = value;
    return target;
  };
  const json unnamed{{"entry_point", {1, 2, 3}}, {"target_point", {4, 5, 6}}};
  const std::pair<json, const char*> wrong[] = {
      {"all", "planned_targets"},
      {json(101, first_core), "planned_targets"},
      {{first_core, first_core}, "planned_targets[1].name"},
      {{first_core, with("name", " core\u200b 1")}, "planned_targets[1].name"},
      {{first_core, 7}, "planned_targets[1]"},
      {json::array({unnamed}), "planned_targets[0].name"},
      {json::array({with("name", "\u200b")}), "planned_targets[0].name"},
      {json::array({with("name", std::string(41, 'n'))}), "planned_targets[0].name"},
      {json::array({with("target_point", {1, 2})}), "planned_targets[0].target_point"},
      {json::array({with("entry_point", {1, 2, 1e5})}), "planned_targets[0].entry_point[2]"},
      {json::array({with("depth", 3)}), "planned_targets[0].depth"},
  };
  for (const auto& [list, field] : wrong) {
    EXPECT_EQ(with_planned_targets({}, planned(list)).error().field, field) << list;
  }
}

TEST(Targeting, AFitThatCannotBeIsRefused) {
  const std::pair<const char*, json> wrong[] = {
      {"residual_mm", -0.1},   {"residual_mm", 1000.1}, {"residual_mm", "far"},
      {"residual_mm", json()}, {"fiducials", 2},        {"fiducials", 1001},
      {"fiducials", 3.5},      {"fiducials", true},     {"fiducial_points", {{0, 0, 0}, {50, 0, 0}}}};
  for (const auto& [name, value] : wrong) {
    const json body{{"registration", turned(0.1)}, {name, value}};
    const auto set = with_registration({}, body);
    ASSERT_FALSE(set) << value;
    EXPECT_EQ(set.error().field, name);
  }
}

TEST(Targeting, AResidualBeyondWhatAMotionMayMissIsDoubted) {
  const Robot& robot = test::neuro();
  for (const auto& [residual_mm, is_doubted] : {std::pair(1.0, false), std::pair(1.01, true)}) {
    Targeting targeting;
    targeting.registration = turned(0.1);
    targeting.override_reason = "tried";
    targeting.residual_mm = residual_mm;
    const std::string doubt = plausible(targeting, robot)->registration_doubt;
    EXPECT_EQ(
        doubt.find("Its residual is 1.01 mm, and a motion may miss by 1.0 mm at most.") != std::string::npos,
        is_doubted)
        << doubt;
  }
}

TEST(Targeting, AReasonThatNobodyCanReadIsNone) {
  for (const char* blank : {"", " ", "  \t\t", "\u200b", "\"\n\"", "\u00a0\u3000"}) {
    const json body{{"registration", turned(0.1)}, {"override_reason", blank}};
    EXPECT_EQ(with_registration({}, body).error().field, "override_reason") << json(blank);
  }
}

TEST(Targeting, NothingIsInForceOfACaseThatNobodyHasResumed) {
  Targeting kept = *with_registration(judged({}, {7}), {{"registration", turned(0.1)}});
  kept.case_number = 3;
  EXPECT_EQ(judged(kept, {7, "", 3}).registration_problem, "");
  for (const std::int64_t open : {0, 2, 4}) {
    const json told = to_json(judged(kept, {7, "", open}));
    EXPECT_EQ(told["registration_state"], "suspended");
    EXPECT_THAT(told["registration_problem"].get<std::string>(),
                testing::StartsWith("The case is suspended"));
  }
}

TEST(Targeting, AReasonThatIsKeptOutlivesTheEpoch) {
  Targeting targeting = *with_registration(judged({}, {7}), {{"registration", turned(0.1)}});
  targeting.registration_expired = "The table moved.";
  const Targeting stored = stored_targeting(to_stored(targeting)).value();
  EXPECT_THAT(judged(stored, {7}).registration_problem, HasSubstr("The table moved."));
  EXPECT_THAT(judged(stored, {9}).registration_problem, HasSubstr("The table moved."));
  const auto again = with_registration(judged(stored, {9}), {{"registration", turned(0.1)}});
  EXPECT_EQ(judged(*again, {9}).registration_problem, "");
}

TEST(Targeting, AReportedPoseReplacesNothingElse) {
  const auto set = with_reported_pose({}, {{"current_position", turned(1)}});
  ASSERT_TRUE(set);
  EXPECT_EQ(set->reported_position, turned(1));
  EXPECT_EQ(set->registration, Targeting{}.registration);
  EXPECT_EQ(with_reported_pose({}, {{"registration", turned(1)}}).error().field, "registration");
  EXPECT_FALSE(with_reported_pose({}, {{"current_position", RowMajor{}}}));
}

TEST(Targeting, ComesBackFromTheStoreAsItWas) {
  Targeting targeting;
  targeting.registration = turned(0.1);
  targeting.registration_epoch = latest_epoch;
  targeting.registration_expired = "The table moved.";
  targeting.ignore_registration_rotation = true;
  targeting.entry_point = Point{0.1, 0.2, 0.3};
  targeting.treatment_to_tip_mm = 1.0 / 3.0;
  targeting.cannula_to_treatment_mm = 2.5;
  targeting.reported_position = turned(2);
  EXPECT_EQ(stored_targeting(json::parse(to_stored(targeting).dump())).value(), targeting);
  EXPECT_EQ(stored_targeting(to_stored(Targeting{})).value(), Targeting{});
  EXPECT_FALSE(stored_targeting(json::array()));
  EXPECT_FALSE(stored_targeting({{"registration", {1, 2}}}));
}

}  // namespace
}  // namespace interlock::web
