#include "http_fixture.hpp"

namespace interlock::web {
namespace {

using test::neuro;

class ModeRoutesTest : public HttpTest {
 protected:
  json mode() { return json::parse(get("/api/mode").body); }

  Answered set_mode(const std::string& name) { return put("/api/mode", json{{"mode", name}}.dump()); }
};

TEST_F(ModeRoutesTest, TheRobotIsDescribedAsItsFileSays) {
  const json robots = json::parse(get("/api/robots").body);
  ASSERT_EQ(robots.size(), 1u);
  const json& robot = robots[0];
  EXPECT_EQ(robot["name"], neuro().name);
  EXPECT_EQ(robot["title"], neuro().title);
  EXPECT_EQ(robot["kinematics"], neuro().family);
  EXPECT_EQ(robot["modes"], json(neuro().modes));
  EXPECT_EQ(robot["axes"].size(), neuro().axes.size());
  ASSERT_EQ(robot["home_steps"].size(), neuro().home_steps.size());
  for (std::size_t i = 0; i < neuro().home_steps.size(); ++i) {
    EXPECT_EQ(robot["home_steps"][i]["name"], neuro().home_steps[i].name);
    EXPECT_FALSE(robot["home_steps"][i]["axes"].empty());
  }
  EXPECT_EQ(robot["config_crc"], json::parse(get("/api/status").body)["config_crc"]);
}

TEST_F(ModeRoutesTest, GoingHomeProposesAllStepsForApprovalAndManualAbortsThem) {
  show(test::ready_view());
  EXPECT_EQ(mode()["mode"], "manual");
  const Answered homing = set_mode("home");
  ASSERT_EQ(homing.status, 200u) << homing.body;
  EXPECT_EQ(json::parse(homing.body)["mode"], "manual") << "until somebody approves it";
  const json proposal = json::parse(get("/api/proposals").body)[0];
  EXPECT_EQ(proposal["kind"], "home");
  EXPECT_EQ(proposal["state"], "checked");
  ASSERT_EQ(post("/api/proposals/1/approve").status, 200u);
  EXPECT_EQ(json::parse(get("/api/status").body)["app_mode"], "home");
  EXPECT_TRUE((next_task().work.find<HomeTask>() != nullptr));
  EXPECT_EQ(json::parse(set_mode("manual").body)["mode"], "manual");
  EXPECT_EQ(std::get<Cancel>(next_command()).task, proposal["id"]);
  EXPECT_EQ(json::parse(get("/api/proposals/1").body)["state"], "aborted");
}

TEST_F(ModeRoutesTest, ManualWhileManualLeavesMovesAlone) {
  show(test::ready_view());
  ASSERT_EQ(post("/api/proposals", R"({"slot":3,"target_counts":1000})").status, 201u);
  EXPECT_EQ(set_mode("manual").status, 200u);
  EXPECT_EQ(json::parse(get("/api/proposals/1").body)["state"], "approved");
}

TEST_F(ModeRoutesTest, AModeThatTheRobotHasNotIsNamedWithThoseThatItHas) {
  show(test::ready_view());
  for (const std::string body :
       {R"({"mode":"sweeping"})", R"({"mode":3})", "{}", R"({"mode":"home","slot":3})"}) {
    const Answered answered = put("/api/mode", body);
    EXPECT_EQ(answered.status, 422u) << body;
    EXPECT_EQ(answered.problem()["code"], "INVALID") << body;
  }
  EXPECT_EQ(set_mode("sweeping").problem()["expected"],
            "one of manual, home, coordinated, trajectory, draping, ablation");
  EXPECT_EQ(put("/api/mode", "{").status, 400u);
  EXPECT_EQ(mode()["mode"], "manual");
}

TEST_F(ModeRoutesTest, GoingHomeIsRefusedAsTheProposalIs) {
  EXPECT_EQ(set_mode("home").problem()["code"], "NO_KERNEL");
  ControlView locked = test::ready_view();
  locked.snapshot.state.system.mode = ILK_MODE_LOCKED;
  show(locked);
  const Answered answered = set_mode("home");
  EXPECT_EQ(answered.status, 409u);
  EXPECT_EQ(answered.problem()["code"], "MODE");
  EXPECT_EQ(mode()["mode"], "manual");
}

TEST_F(ModeRoutesTest, HomingOfAStepOrAnAxisIsProposed) {
  show(test::ready_view());
  const json step{{"kind", "home"}, {"step", neuro().home_steps[0].name}};
  const Answered made = post("/api/proposals", step.dump());
  ASSERT_EQ(made.status, 201u) << made.body;
  EXPECT_EQ(json::parse(made.body)["step"], neuro().home_steps[0].name);
  const std::uint32_t slot = neuro().home_steps[0].home.front();
  const Answered axis = post("/api/proposals", json{{"kind", "home"}, {"slot", slot}}.dump());
  ASSERT_EQ(axis.status, 201u) << axis.body;
  EXPECT_EQ(json::parse(axis.body)["axes"], json::array({neuro().at_slot(slot)->name}));
  EXPECT_EQ(json::parse(get("/api/motors/" + std::to_string(slot)).body)["homing"], true);
  EXPECT_EQ(post("/api/proposals", R"({"slot":3,"target_counts":1000})").problem()["code"], "MODE_HOME");
}

TEST_F(ModeRoutesTest, AWrongWishForHomingIsNamed) {
  show(test::ready_view());
  const std::pair<std::string, std::string> cases[] = {
      {R"({"kind":"fly"})", "kind"},
      {R"({"kind":"home","slot":3,"step":"a"})", "step"},
      {R"({"kind":"home","slot":30})", "slot"},
      {R"({"kind":"home","target":3})", "target"},
      {R"({"kind":"home","step":3})", "step"},
      {R"({"kind":"move","slot":3,"target":1,"step":"a"})", "step"}};
  for (const auto& [body, field] : cases) {
    const Answered answered = post("/api/proposals", body);
    EXPECT_EQ(answered.status, 422u) << body;
    EXPECT_EQ(answered.problem()["field"], field) << body;
  }
  EXPECT_EQ(post("/api/proposals", R"({"kind":"home","step":"nowhere"})").status, 404u);
  EXPECT_EQ(post("/api/proposals", R"({"kind":"home","slot":5})").status, 404u);
  EXPECT_EQ(json::parse(get("/api/proposals").body).size(), 0u);
}

TEST_F(ModeRoutesTest, TheStreamTellsOfEachMode) {
  show(test::ready_view());
  auto stream = open_stream();
  ASSERT_TRUE(stream.next());
  ASSERT_EQ(set_mode("home").status, 200u);
  ASSERT_EQ(post("/api/proposals/1/approve").status, 200u);
  ASSERT_EQ(set_mode("manual").status, 200u);
  std::vector<std::string> modes;
  while (modes.size() < 2) {
    const json message = stream.next_text("mode");
    EXPECT_EQ(message["modes"], json(neuro().modes));
    modes.push_back(message["mode"]);
  }
  EXPECT_THAT(modes, testing::ElementsAre("home", "manual"));
}

}  // namespace
}  // namespace interlock::web
