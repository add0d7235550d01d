#include "http_fixture.hpp"
#include "service/targeting.hpp"

namespace interlock::web {
namespace {

class TargetingRoutesTest : public HttpTest {
 protected:
  json targeting() { return json::parse(get("/api/targeting").body); }
  json history() { return json::parse(get("/api/targeting/history").body); }

  void set(const std::string& what, const json& body) {
    ASSERT_EQ(put("/api/targeting/" + what, body.dump()).status, 200u);
  }
};

const json quarter_turn{"0", -1, 0, 10.5, 1, 0, 0, -20, 0, 0, "1.0", 30, 0, 0, 0, 1};
const json pose_as_numbers{0.0, -1.0, 0.0, 10.5, 1.0, 0.0, 0.0, -20.0,
                           0.0, 0.0,  1.0, 30.0, 0.0, 0.0, 0.0, 1.0};

TEST_F(TargetingRoutesTest, StartsWithTheProbeOfTheRobot) {
  const json values = targeting();
  EXPECT_EQ(values["treatment_to_tip_offset"], test::neuro().probe.treatment_to_tip_mm);
  EXPECT_EQ(values["treatment_to_robot_at_home"], test::neuro().probe.treatment_to_robot_at_home_mm);
  EXPECT_TRUE(values["target_point"].is_null());
}

TEST_F(TargetingRoutesTest, WhatIsSetIsAnsweredAndKept) {
  register_robot(quarter_turn, true);
  ASSERT_EQ(put("/api/targeting/current", json{{"current_position", quarter_turn}}.dump()).status, 200u);
  const json target{
      {"entry_point", {"1", 2, 3}}, {"target_point", {4, 5, 6}}, {"canula_to_treatment_offset", "7.5"}};
  const Answered answered = put("/api/targeting/target", target.dump());
  ASSERT_EQ(answered.status, 200u);
  const json values = targeting();
  EXPECT_EQ(json::parse(answered.body), values);
  EXPECT_EQ(values["registration"], pose_as_numbers);
  EXPECT_EQ(values["reported_position"], pose_as_numbers);
  EXPECT_EQ(values["ignore_registration_rotation"], true);
  EXPECT_EQ(values["entry_point"], json({1.0, 2.0, 3.0}));
  EXPECT_EQ(values["cannula_to_treatment_offset"], 7.5);
  EXPECT_EQ(values["canula_to_treatment_offset"], 7.5);
}

TEST_F(TargetingRoutesTest, WithoutAValidRegistrationNoPoseOfTheScannerIsTold) {
  ControlView view = test::ready_view();
  for (const char* slider : {"head", "feet"}) {
    view.snapshot.state.axis[test::neuro().find(slider)->slot].position_counts = 0;
  }
  show(view);
  set("target", {{"entry_point", {8, 250, 70}}, {"target_point", {5, 200, 60}}});
  const auto poses = [this] { return json::parse(get("/api/targeting/alignment").body); };
  for (const char* problem : {"current_problem", "alignment_problem"}) {
    EXPECT_EQ(poses()[problem]["code"], "NO_REGISTRATION");
  }
  EXPECT_EQ(poses()["frame"], "robot") << "where the robot looks at itself";
  EXPECT_TRUE(poses()["current_body"].is_array());
  EXPECT_TRUE(poses()["current_body_problem"].is_null());
  register_robot(quarter_turn);
  EXPECT_EQ(poses()["frame"], "scanner");
  EXPECT_TRUE(poses()["current"].is_array());
  ASSERT_EQ(post("/api/targeting/registration/expire", R"({"reason":"The patient moved."})").status, 200u);
  EXPECT_EQ(poses()["current_problem"]["text"], "The registration has expired: The patient moved.");
  EXPECT_TRUE(poses()["current"].is_null());
  view.snapshot.state.axis[test::yaw].homed = 0;
  show(view);
  EXPECT_EQ(poses()["current_body_problem"]["code"], "NOT_HOMED");
}

TEST_F(TargetingRoutesTest, AnExpiryIsKeptWithItsReasonAndWhoSetItAgain) {
  register_robot(quarter_turn);
  pass(std::chrono::seconds(5));
  ASSERT_EQ(post("/api/targeting/registration/expire", "{}").status, 200u);
  EXPECT_EQ(post("/api/targeting/registration/expire", "{}").status, 200u) << "nothing more to expire";
  EXPECT_EQ(targeting()["registration_state"], "expired");
  ASSERT_EQ(history()["changes"].size(), 2u);
  EXPECT_EQ(history()["changes"][0]["new"],
            json({{"registration_state", "expired"},
                  {"registration_problem", "The registration has expired: The table moved."}}));
  pass(std::chrono::seconds(5));
  register_robot(quarter_turn);
  EXPECT_EQ(targeting()["registration_state"], "valid");
  EXPECT_EQ(history()["last_set"]["registration"]["time"], iso_8601(now()));
}

TEST_F(TargetingRoutesTest, AnotherHomeOfAnAxisExpiresItWithoutAQuestion) {
  ControlView view = test::ready_view();
  register_robot(quarter_turn);
  while (targeting()["registration_state"] == "valid") {
    view.snapshot.state.axis[test::yaw].position_counts += 40;
    show(view);
  }
  EXPECT_EQ(targeting()["registration_problem"], "The registration has expired: Yaw was given another home.");
  while (history()["changes"].size() < 2) {
    std::this_thread::yield();
  }
  EXPECT_EQ(history()["changes"][0]["user"], "app");
}

TEST_F(TargetingRoutesTest, WhatIsNoReasonIsRefusedAndNothingExpires) {
  register_robot(quarter_turn);
  for (const char* body : {R"({"reason":""})", R"({"reason":7})", R"({"why":"x"})", "[]"}) {
    EXPECT_EQ(post("/api/targeting/registration/expire", body).status, 422u) << body;
  }
  EXPECT_EQ(post("/api/targeting/registration/expire", json{{"reason", std::string(201, 'x')}}.dump()).status,
            422u);
  EXPECT_EQ(targeting()["registration_state"], "valid");
}

TEST_F(TargetingRoutesTest, AChangeIsAuditedWithOldAndNew) {
  ASSERT_EQ(put("/api/targeting/target", R"({"target_point":[1,2,3]})").status, 200u);
  const auto records = audit("setting");
  ASSERT_EQ(records.size(), 1u);
  EXPECT_EQ(records[0]["setting"], "targeting");
  EXPECT_EQ(records[0]["old"], json({{"target_point", nullptr}}));
  EXPECT_EQ(records[0]["new"], json({{"target_point", {1.0, 2.0, 3.0}}}));
}

TEST_F(TargetingRoutesTest, WhatChangesNothingIsNoRecord) {
  EXPECT_EQ(put("/api/targeting/target", "{}").status, 200u);
  EXPECT_TRUE(audit("setting").empty());
  EXPECT_TRUE(history()["last_set"].empty());
  EXPECT_TRUE(history()["changes"].empty());
}

TEST_F(TargetingRoutesTest, TheHistorySaysWhatWasSetWhenByWhomAndFromWhere) {
  set("target", {{"target_point", {1, 2, 3}}});
  pass(std::chrono::seconds(5));
  set("target", {{"target_point", {1, 2, 4}}, {"robot_to_entry_offset", 6}});
  const json told = history();
  ASSERT_EQ(told["changes"].size(), 2u);
  const json& newest = told["changes"][0];
  EXPECT_EQ(newest["new"], json({{"target_point", {1.0, 2.0, 4.0}}, {"robot_to_entry_offset", 6.0}}));
  EXPECT_EQ(newest["old"]["target_point"], json({1.0, 2.0, 3.0}));
  EXPECT_EQ(newest["user"], "edna");
  EXPECT_EQ(newest["source"], "console");
  EXPECT_EQ(newest["client"].get<std::string>().substr(0, 10), "127.0.0.1:");
  EXPECT_EQ(newest["time"], iso_8601(now()));
  pass(std::chrono::seconds(5));
  EXPECT_EQ(history()["now"], iso_8601(now()));
  EXPECT_EQ(newest["record"], audit().back().number);
  EXPECT_EQ(told["last_set"]["target_point"]["record"], newest["record"]);
  EXPECT_FALSE(told["last_set"].contains("entry_point"));
}

TEST_F(TargetingRoutesTest, APoseThatAnImagerReportsCrowdsNothingOutOfTheHistory) {
  set("target", {{"target_point", {1, 2, 3}}});
  set("current", {{"current_position", quarter_turn}});
  const json told = history();
  EXPECT_EQ(told["changes"].size(), 1u);
  EXPECT_EQ(told["last_set"]["reported_position"]["user"], "edna");
}

TEST_F(TargetingRoutesTest, TheHistoryKeepsTheNewestChangesAndWhoSetEachFieldLast) {
  set("target", {{"entry_point", {9, 9, 9}}});
  for (std::size_t x = 0; x < most_targeting_changes; ++x) {
    set("target", {{"target_point", {x, 0, 0}}});
  }
  const json told = history();
  ASSERT_EQ(told["changes"].size(), most_targeting_changes);
  EXPECT_EQ(told["changes"][0]["new"]["target_point"][0], most_targeting_changes - 1.0);
  EXPECT_EQ(told["changes"].back()["new"]["target_point"][0], 0.0);
  EXPECT_TRUE(told["last_set"].contains("entry_point"));
}

TEST_F(TargetingRoutesTest, WhatIsRefusedHasChangedNothing) {
  const json before = targeting();
  const std::pair<std::string, std::string> cases[] = {
      {"registration", R"({"registration":[1,2,3]})"},
      {"registration", R"({"registration":[2,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]})"},
      {"registration", R"({})"},
      {"registration", R"({"registration":"identity"})"},
      {"current", R"({"current_position":[1,0,0,0,0,1,0,0,0,0,-1,0,0,0,0,1]})"},
      {"target", R"({"entry_point":[1,2,"three"]})"},
      {"target", R"({"target_point":[1,2,10001]})"},
      {"target", R"({"robot_to_entry_offset":1001})"},
      {"target", R"({"robot_to_entry_offset":"12mm"})"},
      {"target", R"({"cannula_to_treatment_offset":1,"canula_to_treatment_offset":1})"},
      {"target", R"({"depth":1})"},
      {"target", R"([])"}};
  for (const auto& [path, body] : cases) {
    const Answered answered = put("/api/targeting/" + path, body);
    EXPECT_EQ(answered.status, 422u) << body;
    EXPECT_EQ(answered.problem()["code"], "INVALID") << body;
  }
  EXPECT_EQ(put("/api/targeting/target", "{").problem()["code"], "MALFORMED");
  EXPECT_EQ(targeting(), before);
  EXPECT_TRUE(audit("setting").empty());
}

}  // namespace
}  // namespace interlock::web
