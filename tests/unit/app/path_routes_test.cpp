#include <sstream>

#include "http_fixture.hpp"

namespace interlock::web {
namespace {

class PathRoutesTest : public HttpTest {
 protected:
  PathRoutesTest() { show(test::ready_view()); }

  Answered remove(const std::string& target) {
    Request request{http::verb::delete_, target, 11};
    return send(std::move(request));
  }

  json proposal(int id) { return json::parse(get("/api/proposals/" + std::to_string(id)).body); }

  void report(std::uint32_t proposal, TaskPhase phase) {
    ControlView view = test::ready_view();
    view.tasks.of<PathTask>() = {proposal, phase, TaskReason::arrived, 0, 0};
    show(view);
  }

  void aim_at(const std::string& points) { ASSERT_EQ(put("/api/targeting/target", points).status, 200u); }

  /** All axes as entry and target ask, as far as they go. */
  void stand_as_aligned() {
    const json alignment = json::parse(get("/api/targeting/alignment").body)["alignment"];
    for (const auto& [name, setpoint] : alignment["setpoints"].items()) {
      const std::uint32_t slot = test::neuro().find(name)->slot;
      const std::int32_t now = view_.snapshot.state.axis[slot].position_counts;
      test::move(view_, slot, setpoint["counts"].get<std::int32_t>() - now);
    }
    show(view_);
  }

  ControlView view_ = test::ready_view();
};

constexpr const char* short_trajectory = "time [s],yaw [rad]\n0,-0.5\n2,-0.7\n";

TEST_F(PathRoutesTest, CoordinatedMotionTakesPositionsByAxis) {
  const Answered made = propose({{"kind", "coordinated"}, {"targets", {{"yaw", -0.5}, {"head", -20.0}}}});
  ASSERT_EQ(made.status, 201u) << made.body;
  const json body = json::parse(made.body);
  EXPECT_EQ(body["kind"], "path");
  EXPECT_EQ(body["mode"], "coordinated");
  EXPECT_EQ(body["axes"], json({"yaw", "head"}));
  EXPECT_EQ(body["ends"][0], json({{"slot", 0}, {"target_counts", -398}}));
  EXPECT_EQ(next_task().id, body["id"]);
}

TEST_F(PathRoutesTest, ATargetMayBeANumberInAStringAndAnotherValueIsShown) {
  EXPECT_EQ(propose({{"kind", "coordinated"}, {"targets", {{"yaw", "-0.5"}}}}).status, 201u);
  const json problem = propose({{"kind", "coordinated"}, {"targets", {{"yaw", "far"}}}}).problem();
  EXPECT_EQ(problem["detail"], R"(targets.yaw is "far".)");
  EXPECT_EQ(problem["expected"], "a position of the axis, a number in rad");
}

TEST_F(PathRoutesTest, WhatIsNoCoordinatedMotionIsNamed) {
  const std::pair<json, std::string> cases[] = {
      {{{"kind", "coordinated"}}, "targets"},
      {{{"kind", "coordinated"}, {"targets", json::object()}}, "targets"},
      {{{"kind", "coordinated"}, {"targets", {{"elbow", 1}}}}, "targets.elbow"},
      {{{"kind", "coordinated"}, {"targets", {{"yaw", "far"}}}}, "targets.yaw"},
      {{{"kind", "coordinated"}, {"targets", {{"yaw", 1e300}}}}, "targets.yaw"},
      {{{"kind", "coordinated"}, {"targets", {{"yaw", -0.5}}}, {"duration_s", -1}}, "duration_s"},
      {{{"kind", "pose"}, {"pose", "current"}}, "pose"},
      {{{"kind", "draping"}, {"slot", 1}}, "slot"}};
  for (const auto& [body, field] : cases) {
    const Answered refused = propose(body);
    EXPECT_EQ(refused.status, 422u) << body;
    EXPECT_EQ(refused.problem()["field"], field) << body;
  }
}

TEST_F(PathRoutesTest, APoseIsAlignedWithTheProbeOutFirst) {
  register_robot();
  ASSERT_EQ(put("/api/targeting/target", R"({"entry_point":[8,250,70],"target_point":[5,200,60]})").status,
            200u);
  const Answered made = propose({{"kind", "pose"}, {"insert", true}});
  ASSERT_EQ(made.status, 201u) << made.body;
  const json body = json::parse(made.body);
  EXPECT_EQ(body["legs"], 3);
  const auto path = next_task().work.as<PathTask>();
  const auto& out = std::get<MoveLeg>(path.program->legs.front());
  ASSERT_EQ(out.targets.size(), 1u);
  EXPECT_EQ(out.targets.front(),
            (AxisCounts{test::insertion, test::neuro().at_slot(test::insertion)->lowest_setpoint_counts()}));
  EXPECT_FALSE(out.needs_confirmation);
  EXPECT_TRUE(std::get<MoveLeg>(path.program->legs.back()).needs_confirmation);
}

TEST_F(PathRoutesTest, AnInsertionIsConfirmedOnlyWhileItWaitsForThat) {
  register_robot();
  ASSERT_EQ(put("/api/targeting/target", R"({"entry_point":[8,250,70],"target_point":[5,200,60]})").status,
            200u);
  ASSERT_EQ(propose({{"kind", "pose"}, {"insert", true}}).status, 201u);
  (void)next_task();
  const auto confirm = [this] { return post("/api/proposals/1/confirm"); };
  EXPECT_EQ(confirm().problem()["code"], "NOT_WAITING") << "it is not aligned yet";
  ControlView view = test::ready_view();
  view.tasks.of<PathTask>() = {
      .task = 1, .phase = TaskPhase::paused, .reason = TaskReason::unconfirmed, .step = 2};
  show(view);
  while (proposal(1)["wants_confirmation"] == false) {
    std::this_thread::yield();
  }
  const std::string holder = std::exchange(token_, token_of("ada"));
  EXPECT_EQ(confirm().problem()["code"], "CONTROL");
  token_ = holder;
  ASSERT_EQ(confirm().status, 200u);
  EXPECT_EQ(std::get<Confirmation>(next_command()).task, 1u);
  const std::vector<json> written = audit("proposal");
  EXPECT_NE(std::ranges::find(written, json({{"confirmed", 1}})), written.end());
  ASSERT_EQ(put("/api/targeting/target", R"({"target_point":[5,201,60]})").status, 200u);
  EXPECT_EQ(proposal(1)["wants_confirmation"], false);
  EXPECT_EQ(confirm().problem()["code"], "NOT_WAITING") << "its target has changed";
  EXPECT_EQ(post("/api/proposals/7/confirm").status, 404u);
}

TEST_F(PathRoutesTest, TheProbeComesOutWithoutCaseAndRegistration) {
  ASSERT_EQ(post("/api/cases/1/close").status, 200u);
  ASSERT_EQ(propose({{"kind", "retraction"}}).status, 201u);
  const auto path = next_task().work.as<PathTask>();
  ASSERT_EQ(path.program->legs.size(), 1u);
  EXPECT_EQ(std::get<MoveLeg>(path.program->legs.front()).targets,
            (std::vector<AxisCounts>{
                {test::insertion, test::neuro().at_slot(test::insertion)->lowest_setpoint_counts()}}));
  EXPECT_EQ(propose({{"kind", "retraction"}, {"insert", true}}).status, 422u);
}

TEST_F(PathRoutesTest, AChangedRegistrationEndsThePoseThatFollowedFromTheOldOne) {
  register_robot();
  ASSERT_EQ(put("/api/targeting/target", R"({"entry_point":[8,250,70],"target_point":[5,200,60]})").status,
            200u);
  ASSERT_EQ(propose({{"kind", "pose"}}).status, 201u);
  const json reported{{"current_position", {1, 0, 0, 5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}};
  ASSERT_EQ(put("/api/targeting/current", reported.dump()).status, 200u);
  EXPECT_EQ(proposal(1)["state"], "approved") << "what an imager reports moves nothing";
  register_robot({1, 0, 0, 5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
  EXPECT_EQ(proposal(1)["state"], "aborted");
}

TEST_F(PathRoutesTest, AnUnreachableTargetIsRefusedUntilSomebodyAcceptsTheMissByItsNumbers) {
  register_robot();
  // Straight down the robot's own axis, too far to the side for the lateral axis.
  ASSERT_EQ(put("/api/targeting/target", R"({"entry_point":[60,245,60],"target_point":[60,205,60]})").status,
            200u);
  const Answered refused = propose({{"kind", "pose"}});
  EXPECT_EQ(refused.status, 409u) << refused.body;
  EXPECT_EQ(refused.problem()["code"], "UNREACHABLE");
  EXPECT_NE(refused.problem()["detail"].get<std::string>().find("Lateral"), std::string::npos);
  EXPECT_EQ(propose({{"kind", "pose"}, {"pose", "reachable"}}).status, 422u) << "which miss?";
  const json miss = json::parse(get("/api/targeting/alignment").body)["alignment"]["deviation"];
  json body{{"kind", "pose"},
            {"pose", "reachable"},
            {"accepted_mm", miss["distance_mm"].get<double>() - 0.1},
            {"accepted_deg", miss["angle_deg"]}};
  EXPECT_EQ(propose(body).problem()["code"], "UNREACHABLE") << "more than was accepted";
  body["accepted_mm"] = miss["distance_mm"];
  const Answered made = propose(body);
  ASSERT_EQ(made.status, 201u) << made.body;
  EXPECT_EQ(json::parse(made.body)["aim"]["deviation"], miss) << "kept with the motion";
}

TEST_F(PathRoutesTest, AnExpiredRegistrationEndsThePoseThatFollowedFromItAndThereIsNoOther) {
  constexpr const char* target = R"({"entry_point":[8,250,70],"target_point":[5,200,60]})";
  ASSERT_EQ(put("/api/targeting/target", target).status, 200u);
  const Answered never = propose({{"kind", "pose"}});
  EXPECT_EQ(never.status, 409u);
  EXPECT_EQ(never.problem()["code"], "NO_REGISTRATION");
  register_robot();
  ASSERT_EQ(propose({{"kind", "pose"}}).status, 201u);
  ASSERT_EQ(post("/api/targeting/registration/expire", "{}").status, 200u);
  EXPECT_EQ(proposal(1)["state"], "aborted");
  const json again = propose({{"kind", "pose"}}).problem();
  EXPECT_EQ(again["code"], "NO_REGISTRATION");
  EXPECT_EQ(again["detail"], "The registration has expired: The table moved.");
  register_robot();
  EXPECT_EQ(propose({{"kind", "pose"}}).problem()["code"], "NO_TARGET") << "the patient moved with the table";
  ASSERT_EQ(put("/api/targeting/target", target).status, 200u);
  EXPECT_EQ(propose({{"kind", "pose"}}).status, 201u) << "a person says that it still holds";
}

TEST_F(PathRoutesTest, WithoutATargetThereIsNoPose) {
  register_robot();
  const Answered refused = propose({{"kind", "pose"}});
  EXPECT_EQ(refused.status, 409u);
  EXPECT_EQ(refused.problem()["code"], "NO_TARGET");
}

TEST_F(PathRoutesTest, ATrajectoryIsLoadedProposedApprovedAndUnloadedOnceDone) {
  const Answered loaded = put("/api/trajectory", short_trajectory);
  ASSERT_EQ(loaded.status, 200u) << loaded.body;
  EXPECT_EQ(json::parse(loaded.body)["rows"], 2);
  EXPECT_EQ(json::parse(loaded.body)["author"], "edna");
  const Answered made = post("/api/proposals", R"({"kind":"trajectory"})");
  ASSERT_EQ(made.status, 201u) << made.body;
  EXPECT_EQ(json::parse(made.body)["state"], "checked");
  EXPECT_EQ(json::parse(get("/api/mode").body)["mode"], "manual");
  const Answered approved = post("/api/proposals/1/approve");
  ASSERT_EQ(approved.status, 200u) << approved.body;
  EXPECT_EQ(json::parse(get("/api/mode").body)["mode"], "trajectory");
  EXPECT_EQ(next_task().id, 1u);
  report(1, TaskPhase::done);
  EXPECT_EQ(proposal(1)["state"], "done");
  EXPECT_EQ(json::parse(get("/api/trajectory").body)["rows"], 0);
  EXPECT_EQ(json::parse(get("/api/mode").body)["mode"], "manual");
}

TEST_F(PathRoutesTest, WithoutATrajectoryTheRobotStaysInManual) {
  const Answered refused = put("/api/mode", R"({"mode":"trajectory"})");
  EXPECT_EQ(refused.status, 409u);
  EXPECT_EQ(refused.problem()["code"], "EMPTY");
  EXPECT_EQ(json::parse(get("/api/mode").body)["mode"], "manual");
  EXPECT_EQ(put("/api/mode", R"({"mode":"coordinated"})").problem()["code"], "NO_TARGETS");
}

TEST_F(PathRoutesTest, ABadTrajectoryIsRefusedWholeWithItsLine) {
  ASSERT_EQ(put("/api/trajectory", short_trajectory).status, 200u);
  std::ostringstream rows;
  rows << "time [s],yaw [rad]\n";
  for (int row = 0; row < 2000; ++row) {
    rows << row << ',' << (row == 975 ? 3.0 : -0.5) << '\n';
  }
  const Answered refused = put("/api/trajectory", rows.str());
  EXPECT_EQ(refused.status, 422u);
  EXPECT_EQ(refused.problem()["code"], "OUT_OF_RANGE");
  EXPECT_EQ(refused.problem()["field"], "yaw [rad]");
  EXPECT_NE(refused.problem()["detail"].get<std::string>().find("line 977"), std::string::npos);
  EXPECT_EQ(put("/api/trajectory", "time [s],yaw [rad]\n0,-0.5\n0.1,-0.9\n").problem()["code"], "TOO_FAST");
  EXPECT_EQ(put("/api/trajectory", "").problem()["code"], "EMPTY");
  EXPECT_EQ(json::parse(get("/api/trajectory").body)["rows"], 2) << "what was loaded stays";
  EXPECT_EQ(remove("/api/trajectory").status, 200u);
  EXPECT_EQ(json::parse(get("/api/trajectory").body)["rows"], 0);
}

TEST_F(PathRoutesTest, OnlyTheHolderMaySendALargeTrajectory) {
  std::ostringstream rows;
  rows << "time [s],yaw [rad]\n";
  for (int row = 0; row < 20000; ++row) {
    rows << row << ",-0.5\n";
  }
  ASSERT_GT(rows.str().size(), longest_body);
  EXPECT_EQ(put("/api/trajectory", rows.str()).status, 200u);
  become_nobody();
  EXPECT_EQ(put("/api/trajectory", rows.str()).status, 413u);
}

TEST_F(PathRoutesTest, AblationTurnsAndInsertsTheProbeThroughItsSteps) {
  const json steps{{{"probe_rotation", 0.5}, {"insertion", 10.0}, {"dwell_s", 2.0}},
                   {{"probe_rotation", -0.5}, {"insertion", 12.0}, {"dwell_s", 0.0}}};
  EXPECT_EQ(propose({{"kind", "ablation"}, {"steps", steps}}).problem()["code"], "NO_REGISTRATION");
  register_robot();
  EXPECT_EQ(propose({{"kind", "ablation"}, {"steps", steps}}).problem()["code"], "NO_TARGET");
  aim_at(R"({"entry_point":[8,250,70],"target_point":[5,200,60]})");
  const json elsewhere = propose({{"kind", "ablation"}, {"steps", steps}}).problem();
  EXPECT_EQ(elsewhere["code"], "NOT_ALIGNED");
  EXPECT_NE(elsewhere["detail"].get<std::string>().find("Yaw"), std::string::npos) << elsewhere;
  stand_as_aligned();
  const Answered made = propose({{"kind", "ablation"}, {"steps", steps}});
  ASSERT_EQ(made.status, 201u) << made.body;
  const json body = json::parse(made.body);
  EXPECT_EQ(body["mode"], "ablation");
  EXPECT_EQ(body["axes"], json({"probe_rotation", "insertion"}));
  EXPECT_EQ(body["legs"], 2);
  EXPECT_GT(body["duration_s"], 2.0);
  const Task task = next_task();
  EXPECT_TRUE(task.targeting_revision);
  EXPECT_EQ(task.rests_on.size(), 7u);
  const auto path = task.work.as<PathTask>();
  EXPECT_EQ(std::get<MoveLeg>(path.program->legs.front()).dwell_s, 2.0);
  const std::pair<json, std::string> wrong[] = {
      {json::array(), "steps"},
      {json(201, steps[0]), "steps"},
      {{steps[0], {{"probe_rotation", 0.5}, {"insertion", 10.0}}}, "steps[1].dwell_s"},
      {{{{"probe_rotation", 1e300}, {"insertion", 10.0}, {"dwell_s", 2.0}}}, "steps[0]"}};
  for (const auto& [bad, field] : wrong) {
    const Answered refused = propose({{"kind", "ablation"}, {"steps", bad}});
    EXPECT_EQ(refused.status, 422u) << bad;
    EXPECT_EQ(refused.problem()["field"], field) << bad;
  }
}

TEST_F(PathRoutesTest, AtATargetOutOfReachNothingIsTreatedUnlessSomebodyAcceptedTheMiss) {
  const json ablation{{"kind", "ablation"},
                      {"steps", json::array({{{"probe_rotation", 0.5}, {"insertion", 10}, {"dwell_s", 1}}})}};
  register_robot();
  aim_at(R"({"entry_point":[60,245,60],"target_point":[60,205,60]})");
  stand_as_aligned();
  EXPECT_EQ(propose(ablation).problem()["code"], "UNREACHABLE");
  ASSERT_EQ(
      propose({{"kind", "pose"}, {"pose", "reachable"}, {"accepted_mm", 500}, {"accepted_deg", 90}}).status,
      201u);
  EXPECT_EQ(propose(ablation).problem()["code"], "UNREACHABLE") << "it was not aligned yet";
  view_.tasks.of<PathTask>() = {1, TaskPhase::done, TaskReason::arrived, 0, 0};
  show(view_);
  EXPECT_EQ(proposal(1)["state"], "done");
  EXPECT_EQ(propose(ablation).status, 201u);
}

TEST_F(PathRoutesTest, DrapingGoesToTheSetpointsOfTheFile) {
  ASSERT_EQ(put("/api/mode", R"({"mode":"draping"})").status, 200u);
  const json made = proposal(1);
  EXPECT_EQ(made["mode"], "draping");
  EXPECT_EQ(made["axes"], json({"yaw", "pitch", "head", "feet"}));
  ASSERT_EQ(post("/api/proposals/1/approve").status, 200u);
  EXPECT_EQ(put("/api/mode", R"({"mode":"manual"})").status, 200u);
  EXPECT_EQ(proposal(1)["state"], "aborted");
}

}  // namespace
}  // namespace interlock::web
