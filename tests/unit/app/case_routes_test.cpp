#include <chrono>
#include <filesystem>
#include <fstream>
#include <set>

#include "http_fixture.hpp"
#include "service/targeting.hpp"

namespace interlock::web {
namespace {

const json quarter_turn{0, -1, 0, 10.5, 1, 0, 0, -20, 0, 0, 1, 30, 0, 0, 0, 1};
constexpr const char* some_target = R"({"entry_point":[8,250,70],"target_point":[5,200,60]})";

class CaseRoutesTest : public HttpTest {
 protected:
  json cases() { return json::parse(get("/api/cases").body); }
  json targeting() { return json::parse(get("/api/targeting").body); }

  Answered step(const std::string& number_and_step) { return post("/api/cases/" + number_and_step); }

  void take(const std::string& number_and_step) {
    const Answered taken = step(number_and_step);
    ASSERT_EQ(taken.status, 200u) << taken.body;
  }

  void aim() {
    register_robot(quarter_turn);
    ASSERT_EQ(put("/api/targeting/target", some_target).status, 200u);
  }

  std::string code_of(const Answered& answered) { return json::parse(answered.body)["code"]; }
};

TEST_F(CaseRoutesTest, TellsTheCaseInHandWithWhatIsInForceAndByWhom) {
  aim();
  const json open = cases().at(0);
  EXPECT_EQ(open["number"], 1);
  EXPECT_EQ(open["label"], "of the test");
  EXPECT_EQ(open["state"], "open");
  EXPECT_TRUE(open["problem"].is_null());
  EXPECT_EQ(open["robot"], test::neuro().name);
  EXPECT_EQ(open["configuration_changed"], false);
  EXPECT_EQ(open["opened"], json({{"time", iso_8601(now())}, {"user", "edna"}}));
  EXPECT_EQ(open["targeting"], targeting());
  EXPECT_EQ(open["targeting"]["case"], 1);
  EXPECT_EQ(open["last_set"]["target_point"]["user"], "edna");
}

TEST_F(CaseRoutesTest, WithoutAnOpenCaseNothingIsSetAndNoPoseIsTold) {
  show(test::ready_view());
  aim();
  const auto expect_nothing = [&](const std::string& problem) {
    const Answered refused = put("/api/targeting/target", some_target);
    EXPECT_EQ(refused.status, 409u);
    EXPECT_EQ(code_of(refused), "NO_CASE");
    EXPECT_EQ(put("/api/targeting/registration",
                  json{{"registration", quarter_turn}, {"override_reason", "x"}}.dump())
                  .status,
              409u);
    EXPECT_EQ(put("/api/targeting/current", json{{"current_position", quarter_turn}}.dump()).status, 409u);
    EXPECT_EQ(targeting()["registration_problem"], problem);
    const json view = json::parse(get("/api/targeting/alignment").body);
    EXPECT_EQ(view["alignment_problem"]["text"], problem);
    EXPECT_EQ(view["frame"], "robot");
    const Answered pose = post("/api/proposals", R"({"kind":"pose"})");
    EXPECT_EQ(code_of(pose), "NO_REGISTRATION");
  };
  take("1/suspend");
  expect_nothing("The case is suspended: edna suspended it.");
  EXPECT_EQ(targeting()["registration_state"], "suspended");
  EXPECT_FALSE(targeting()["target_point"].is_null()) << "to be looked at before it is resumed";
  take("1/close");
  expect_nothing("No case is open.");
  EXPECT_TRUE(targeting()["target_point"].is_null());
  EXPECT_TRUE(targeting()["case"].is_null());
}

TEST_F(CaseRoutesTest, WhatWasInForceIsSoAgainOnceSomebodyResumesTheCase) {
  aim();
  const json before = targeting();
  take("1/suspend");
  take("1/resume");
  EXPECT_EQ(targeting(), before);
  take("1/suspend");
  ASSERT_EQ(post("/api/targeting/registration/expire", "{}").status, 200u);
  take("1/resume");
  EXPECT_EQ(targeting()["registration_problem"], "The registration has expired: The table moved.");
  EXPECT_TRUE(targeting()["target_point"].is_null()) << "the patient moved with the table";
}

TEST_F(CaseRoutesTest, WhenTheStoreDoesNotTakeThatTheTableMovedTheCaseIsSuspended) {
  aim();
  const auto execute = [this](const char* sql) {
    ASSERT_TRUE(mine_.transact([&](Transaction& transaction) -> Stored<void> {
      transaction.database().exec(sql);
      return {};
    }));
  };
  execute("CREATE TRIGGER no_records BEFORE INSERT ON audit BEGIN SELECT RAISE(ABORT, 'refused'); END");
  EXPECT_EQ(code_of(post("/api/targeting/registration/expire", "{}")), "STORE");
  execute("DROP TRIGGER no_records");
  EXPECT_EQ(json::parse(get("/api/cases").body)[0]["state"], "suspended");
  take("1/resume");
  EXPECT_EQ(targeting()["registration_state"], "expired");
  EXPECT_FALSE(targeting()["target_point"].is_null()) << "somebody has looked at it";
}

TEST_F(CaseRoutesTest, TheNextCaseBeginsWithNothingOfTheOneBefore) {
  aim();
  ASSERT_EQ(put("/api/targeting/target", R"({"treatment_to_tip_offset":7})").status, 200u);
  const Answered second = post("/api/cases", R"({"label":"another"})");
  EXPECT_EQ(code_of(second), "CASE") << "while one is in hand";
  take("1/close");
  ASSERT_EQ(post("/api/cases", R"({"label":"another"})").status, 201u);
  EXPECT_EQ(targeting()["case"], 2);
  EXPECT_TRUE(targeting()["registration"].is_null());
  EXPECT_TRUE(targeting()["target_point"].is_null());
  EXPECT_EQ(targeting()["treatment_to_tip_offset"], test::neuro().probe.treatment_to_tip_mm);
  EXPECT_EQ(json::parse(get("/api/targeting/history").body)["changes"], json::array());
}

TEST_F(CaseRoutesTest, ProposalsBelongToTheOpenCaseAndEndWithIt) {
  show(test::ready_view());
  const json homing{{"kind", "home"}};
  const json first = json::parse(post("/api/proposals", homing.dump()).body);
  EXPECT_EQ(first["case"], 1);
  EXPECT_EQ(first["state"], "checked");
  take("1/suspend");
  const std::string id = first["id"].dump();
  const json ended = json::parse(get("/api/proposals/" + id).body);
  EXPECT_EQ(ended["state"], "aborted");
  EXPECT_EQ(ended["detail"], "Its case was suspended or closed; propose it again.");
  const json outside = json::parse(post("/api/proposals", homing.dump()).body);
  EXPECT_TRUE(outside["case"].is_null());
  take("1/resume");
  EXPECT_EQ(json::parse(get("/api/proposals/" + outside["id"].dump()).body)["state"], "checked");
}

TEST_F(CaseRoutesTest, AMotionOfTheCaseIsCancelledOnTheControlThread) {
  show(test::ready_view());
  const json move{{"slot", test::yaw}, {"target_counts", -400}};
  const Answered made = propose(move);
  ASSERT_EQ(made.status, 201u) << made.body;
  const json moving = json::parse(made.body);
  EXPECT_EQ(next_task().id, moving["id"]);
  take("1/close");
  EXPECT_EQ(std::get<Cancel>(next_command()).task, moving["id"]);
}

TEST_F(CaseRoutesTest, EachStateAllowsItsStepsAndNoOther) {
  EXPECT_EQ(code_of(step("1/resume")), "CASE");
  take("1/suspend");
  EXPECT_EQ(code_of(step("1/suspend")), "CASE");
  take("1/resume");
  take("1/close");
  for (const char* late : {"1/close", "1/suspend", "1/resume"}) {
    EXPECT_EQ(code_of(step(late)), "CASE") << late;
  }
  EXPECT_EQ(code_of(post("/api/cases/1/notes", R"({"text":"late"})")), "CASE");
  for (const char* unknown :
       {"2/close", "0/close", "-1/close", "x/close", "1.5/close", "99999999999999999999/resume"}) {
    EXPECT_EQ(step(unknown).status, 404u) << unknown;
  }
}

TEST_F(CaseRoutesTest, OpeningAndResumingNeedControlAndAnEndDoesNot) {
  log_in("ada");
  EXPECT_EQ(code_of(step("1/resume")), "CONTROL");
  take("1/suspend");
  take("1/close");
  EXPECT_EQ(code_of(post("/api/cases", R"({"label":"mine"})")), "CONTROL");
  log_in("vic");
  EXPECT_EQ(step("1/close").status, 403u);
  EXPECT_EQ(get("/api/cases/1").status, 403u);
  EXPECT_EQ(get("/api/cases").status, 200u);
  log_in("edna");
  EXPECT_EQ(send({http::verb::delete_, "/api/cases/1", 11}).status, 403u);
}

TEST_F(CaseRoutesTest, WhatIsNoLabelOrNoteIsRefused) {
  take("1/close");
  for (const json& label : {json(""), json("   "), json("two\nlines"), json(std::string(81, 'x')), json(7),
                            json("\u202eabc"), json(nullptr)}) {
    EXPECT_EQ(post("/api/cases", json{{"label", label}}.dump()).status, 422u) << label;
  }
  EXPECT_EQ(post("/api/cases", "{}").status, 422u);
  std::string umlauts;
  for (int i = 0; i < 80; ++i) {
    umlauts += "ü";
  }
  EXPECT_EQ(post("/api/cases", json{{"label", umlauts}}.dump()).status, 201u);
  EXPECT_EQ(post("/api/cases/2/notes", json{{"text", std::string(1001, 'x')}}.dump()).status, 422u);
}

TEST_F(CaseRoutesTest, NotesAreKeptWithWhoWroteThemAndNoMoreThan200) {
  for (int i = 0; i < 200; ++i) {
    ASSERT_EQ(post("/api/cases/1/notes", json{{"text", "note " + std::to_string(i)}}.dump()).status, 200u);
  }
  EXPECT_EQ(code_of(post("/api/cases/1/notes", R"({"text":"one more"})")), "CASE");
  const json notes = cases().at(0)["notes"];
  ASSERT_EQ(notes.size(), 200u);
  EXPECT_EQ(notes[199], json({{"time", iso_8601(now())}, {"user", "edna"}, {"text", "note 199"}}));
}

TEST_F(CaseRoutesTest, TheExportHoldsWhatHappenedFromOpeningToClosingAndNothingElse) {
  show(test::ready_view());
  aim();
  (void)post("/api/proposals", R"({"kind":"home"})");
  ASSERT_EQ(post("/api/cases/1/notes", R"({"text":"a remark"})").status, 200u);
  take("1/close");
  (void)post("/api/proposals", R"({"kind":"home"})");
  const json whole = json::parse(get("/api/cases/1").body);
  EXPECT_EQ(whole["schema"], "interlock.case/1");
  EXPECT_EQ(whole["state"], "closed");
  EXPECT_EQ(whole["records_complete"], true);
  EXPECT_EQ(whole["targeting"]["target_point"], json({5, 200, 60}));
  EXPECT_EQ(whole["changes"].size(), 2u);
  EXPECT_EQ(whole["notes"].size(), 1u);
  const json& records = whole["records"];
  EXPECT_EQ(records.front()["detail"], json({{"action", "open"}, {"case", 1}}));
  EXPECT_EQ(records.back()["detail"], json({{"action", "close"}, {"case", 1}}));
  std::set<std::string> kinds;
  for (const json& record : records) {
    kinds.insert(record["kind"]);
  }
  EXPECT_EQ(kinds, (std::set<std::string>{"case", "proposal", "setting"}));
  EXPECT_EQ(get("/api/cases/2").status, 404u);
}

TEST_F(CaseRoutesTest, TheExportNamesTheRecordingsThatWereFinishedFromOpeningToClosing) {
  namespace fs = std::filesystem;
  const fs::path recordings = folder_.path() / "recordings";
  fs::create_directory(recordings);
  in_network([&] { api_.compare_with(recordings / "audit-heads"); });
  const auto finish = [&](const char* name, std::chrono::seconds after) {
    std::ofstream(recordings / name) << "recorded";
    fs::last_write_time(recordings / name, std::chrono::file_clock::from_sys(now() + after));
  };
  const auto named = [this] { return json::parse(get("/api/cases/1").body)["recordings"]; };
  EXPECT_EQ(named(), json::array());
  finish("before.ilkr", std::chrono::seconds(-1));
  finish("within.ilkr", std::chrono::seconds(3));
  finish("unfinished.ilkr.part", std::chrono::seconds(3));
  EXPECT_EQ(named(), json::array({"within.ilkr"}));
  pass(std::chrono::seconds(10));
  take("1/close");
  finish("at_the_end.ilkr", std::chrono::seconds(4));
  finish("of_the_next.ilkr", std::chrono::seconds(6));
  EXPECT_EQ(named(), json::array({"at_the_end.ilkr", "within.ilkr"}));
}

TEST_F(CaseRoutesTest, AClosedCaseIsDeletedWithWhatPeopleWroteInIt) {
  ASSERT_EQ(post("/api/cases/1/notes", R"({"text":"Smith, John"})").status, 200u);
  const std::string holder = std::exchange(token_, token_of("ada"));
  const auto remove = [this] { return send({http::verb::delete_, "/api/cases/1", 11}); };
  EXPECT_EQ(code_of(remove()), "CASE") << "it is not closed";
  take("1/close");
  EXPECT_EQ(remove().status, 200u);
  EXPECT_EQ(cases(), json::array());
  EXPECT_EQ(remove().status, 404u);
  for (const AuditRecord& record : audit()) {
    EXPECT_EQ(record.detail.find("Smith"), std::string::npos);
    EXPECT_EQ(record.detail.find("of the test"), std::string::npos);
  }
  EXPECT_EQ(audit("case").back(), json({{"action", "delete"}, {"case", 1}}));
  token_ = holder;
  ASSERT_EQ(post("/api/cases", R"({"label":"next"})").status, 201u);
  EXPECT_EQ(cases().at(0)["number"], 2) << "a number means one case";
}

}  // namespace
}  // namespace interlock::web
