#include "http_fixture.hpp"
#include "store/settings.hpp"

namespace interlock::web {
namespace {

class HoldRoutesTest : public HttpTest {
 protected:
  HoldRoutesTest() {
    add_user("iris", Role::engineer);
    show(test::ready_view());
  }

  [[nodiscard]] GateState gate(std::chrono::milliseconds later = {}) {
    const BreathingGate& gate = channel_->holds.newest().gate;
    return gate.at(test::ready_view().moment(std::chrono::steady_clock::now() + later));
  }

  Answered signal(const std::string& state, int valid_ms = 2000) {
    return post("/api/holds/gate/signal", json{{"state", state}, {"valid_ms", valid_ms}}.dump());
  }

  Answered scan(bool active) { return put("/api/holds/scan", json{{"active", active}}.dump()); }
  Answered use_gate(bool in_use) { return put("/api/holds/gate", json{{"in_use", in_use}}.dump()); }
};

TEST_F(HoldRoutesTest, AGateInUseIsClosedUntilASignalSaysOpenAndForItsValidity) {
  EXPECT_EQ(gate(), GateState::off);
  ASSERT_EQ(use_gate(true).status, 200u);
  EXPECT_EQ(gate(), GateState::no_signal);
  const Answered answered = signal("open");
  ASSERT_EQ(answered.status, 200u) << answered.body;
  EXPECT_EQ(json::parse(answered.body)["gate"]["source"], "edna, session 1");
  EXPECT_EQ(gate(), GateState::open);
  EXPECT_EQ(gate(std::chrono::milliseconds(2000)), GateState::no_signal);
  ASSERT_EQ(signal("hold").status, 200u);
  EXPECT_EQ(gate(), GateState::hold);
  EXPECT_EQ(signal("open", 49).status, 422u);
  EXPECT_EQ(signal("open", 2001).status, 422u);
  EXPECT_EQ(signal("maybe").status, 422u);
}

TEST_F(HoldRoutesTest, OnlyWhoeverIsInControlTurnsTheGateOnAndOffAndThatIsRecorded) {
  ASSERT_EQ(use_gate(true).status, 200u);
  log_in("iris");
  EXPECT_EQ(use_gate(false).status, 409u);
  EXPECT_EQ(signal("open").status, 200u) << "a signal needs no control";
  log_in("edna");
  EXPECT_EQ(use_gate(false).status, 409u) << "another session of whoever is in control";
  EXPECT_NE(gate(), GateState::off);
}

TEST_F(HoldRoutesTest, TheGateHasOneSourceWhoseEndClosesIt) {
  ASSERT_EQ(use_gate(true).status, 200u);
  const std::string iris = token_of("iris");
  ASSERT_EQ(as(iris, [&] { return signal("open"); }).status, 200u);
  EXPECT_EQ(signal("open").problem()["code"], "GATE_SOURCE");
  EXPECT_EQ(gate(), GateState::open);
  EXPECT_EQ(signal("hold").status, 200u) << "whoever says so is believed";
  EXPECT_EQ(gate(), GateState::hold);
  EXPECT_EQ(as(iris, [&] { return signal("open"); }).problem()["code"], "GATE_SOURCE");
  EXPECT_EQ(gate(), GateState::hold);
  ASSERT_EQ(post("/api/logout").status, 200u);
  EXPECT_EQ(gate(), GateState::no_signal);
  log_in("iris");
  EXPECT_EQ(signal("open").status, 200u) << "another source may take its place";
}

TEST_F(HoldRoutesTest, WhoeverSaysHoldTakesNeitherTheHoldNorTheOpeningOfAnotherAway) {
  ControlView view = test::ready_view();
  view.snapshot.clock = ILK_CLOCK_SIM;
  view.snapshot.period_us = 1000;
  show(view);
  const auto state = [&] {
    return channel_->holds.newest().gate.at(view.moment(std::chrono::steady_clock::now()));
  };
  ASSERT_EQ(use_gate(true).status, 200u);
  const std::string iris = token_of("iris");
  for (const char* const said : {"hold", "open"}) {
    ASSERT_EQ(signal(said).status, 200u);
    ASSERT_EQ(as(iris, [&] { return signal("hold", 50); }).status, 200u);
    EXPECT_EQ(as(iris, [&] { return signal("open"); }).problem()["code"], "GATE_SOURCE") << said;
    EXPECT_EQ(state(), GateState::hold);
  }
  ASSERT_EQ(as(iris, [&] { return signal("hold", 50); }).status, 200u);
  EXPECT_EQ(signal("open").problem()["code"], "GATE_SOURCE") << "of whoever opened it before, too";
  view.snapshot.state.system.tick += 50;
  show(view);
  EXPECT_EQ(state(), GateState::no_signal);
  EXPECT_EQ(signal("open").status, 200u) << "the other hold is over";
  EXPECT_EQ(state(), GateState::open);
}

TEST_F(HoldRoutesTest, DuringAScanNothingIsApprovedNorJoggedAndProposalsWait) {
  ASSERT_EQ(scan(true).status, 200u);
  EXPECT_TRUE(channel_->holds.newest().scanning);
  for (const auto& [path, body] :
       {std::pair<std::string, json>("/api/proposals", {{"slot", 3}, {"target_counts", 1000}}),
        {"/api/jog", {{"slot", 3}, {"direction", "increasing"}}}}) {
    show(test::ready_view());
    const Answered refused = post(path, body.dump());
    EXPECT_EQ(refused.status, 409u) << path;
    EXPECT_EQ(refused.problem()["code"], "SCANNING") << path;
  }
  Command command;
  EXPECT_FALSE(channel_->commands.pop(command));
  ASSERT_EQ(scan(false).status, 200u);
  EXPECT_FALSE(channel_->holds.newest().scanning);
  show(test::ready_view());
  EXPECT_EQ(post("/api/proposals", R"({"slot":3,"target_counts":1000})").status, 201u);
}

TEST_F(HoldRoutesTest, AScanIsEndedByItsSourceOrWhoeverIsInControlAndOutlivesItsSource) {
  const std::string iris = token_of("iris");
  add_user("otto", Role::engineer);
  const std::string otto = token_of("otto");
  ASSERT_EQ(as(iris, [&] { return scan(true); }).status, 200u);
  EXPECT_EQ(as(otto, [&] { return scan(false); }).problem()["code"], "SCANNING");
  EXPECT_EQ(as(iris, [&] { return scan(false); }).status, 200u);
  ASSERT_EQ(as(iris, [&] { return scan(true); }).status, 200u);
  ASSERT_EQ(as(iris, [&] { return post("/api/logout"); }).status, 200u);
  pass(std::chrono::seconds(70));
  const json shown = json::parse(get("/api/holds").body)["scan"];
  EXPECT_EQ(shown["active"], true);
  EXPECT_EQ(shown["age_s"], 70.0);
  EXPECT_EQ(scan(false).status, 200u) << "whoever is in control";
  std::vector<json> scans;
  for (const json& detail : audit("setting")) {
    if (detail.contains("scan")) {
      scans.push_back(detail["scan"]);
    }
  }
  EXPECT_THAT(scans, testing::ElementsAre("begun", "ended", "begun", "ended"));
}

TEST_F(HoldRoutesTest, WhatIsHeldOutlivesARestart) {
  ASSERT_EQ(use_gate(true).status, 200u);
  ASSERT_EQ(scan(true).status, 200u);
  const auto kept = [this] {
    return *mine_.read([](Transaction& transaction) -> Stored<std::optional<Setting>> {
      return Settings(transaction).find(HoldService::setting);
    });
  };
  while (!kept() || kept()->value["scan"].is_null()) {
    std::this_thread::yield();
  }
  const json before = kept()->value;
  ASSERT_EQ(scan(false).status, 200u);
  ASSERT_EQ(use_gate(false).status, 200u);
  pass(std::chrono::seconds(30));
  in_network([&] { api_.restore_holds(before); });
  EXPECT_EQ(gate(), GateState::no_signal);
  const json shown = json::parse(get("/api/holds").body)["scan"];
  EXPECT_EQ(shown["age_s"], 30.0);
  EXPECT_EQ(shown["source"], "edna, session 1");
  show(test::ready_view());
  EXPECT_EQ(post("/api/proposals", R"({"slot":3,"target_counts":1000})").problem()["code"], "SCANNING");
}

TEST_F(HoldRoutesTest, ConsolesLearnOfEachChange) {
  auto stream = open_stream();
  ASSERT_EQ(scan(true).status, 200u);
  while (stream.next_text("holds")["scan"]["active"] != true) {
  }
}

}  // namespace
}  // namespace interlock::web
