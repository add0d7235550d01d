// Who may have an axis measured on a running robot, and what comes of it for the robot's file.
#include "http_fixture.hpp"

namespace interlock::web {
namespace {

constexpr const char* measure_yaw = R"({"kind":"identify","axis":"yaw","cleared":true})";

class IdentificationRoutesTest : public HttpTest {
 protected:
  IdentificationRoutesTest() {
    const Axis& insertion = *test::neuro().with_role("insertion");
    view_.snapshot.state.axis[insertion.slot].position_counts = insertion.lowest_setpoint_counts();
    EXPECT_EQ(post("/api/cases/1/close").status, 200u);
    show(view_);
  }

  void expect_refused(const std::string& code, const char* body = measure_yaw) {
    const Answered refused = post("/api/proposals", body);
    EXPECT_EQ(refused.problem()["code"], code) << refused.body;
    EXPECT_FALSE(refused.problem()["expected"].get<std::string>().empty());
  }

  json proposed() {
    const Answered made = post("/api/proposals", measure_yaw);
    EXPECT_EQ(made.status, 201u) << made.body;
    return json::parse(made.body);
  }

  json now_of(const json& proposal) {
    return json::parse(get("/api/proposals/" + proposal["id"].dump()).body);
  }

  /** The control thread has measured it. */
  void report(const json& proposal, TaskPhase phase) {
    MeasuredAxis& found = view_.measured;
    found.noise_counts = 1;
    found.coast_counts = 6;
    found.speeds = {{0xEFFF, 700, 700}, {0x7800, 330, 330}, {0x400, 0, 0}};
    found.dead_zone_drive = 4000;
    found.full_speed_counts_per_s = 700;
    found.backlash_counts = 1.1;
    view_.tasks.of<IdentificationTask>() = {proposal["id"], phase, TaskReason::measured, 0, 0, 0, 40};
    show(view_);
  }

  ControlView view_ = test::ready_view();
};

TEST_F(IdentificationRoutesTest, AnAxisIsMeasuredOnlyOnceItIsApproved) {
  const json made = proposed();
  EXPECT_EQ(made["state"], "checked") << "of one axis, and all the same no move by hand";
  EXPECT_TRUE(made["measured"].is_null());
  const Axis& yaw = *test::neuro().find("yaw");
  EXPECT_GE(made["lowest_counts"], yaw.lowest_setpoint_counts());
  EXPECT_LE(made["highest_counts"], yaw.highest_setpoint_counts());
  ASSERT_EQ(post("/api/proposals/" + made["id"].dump() + "/approve").status, 200u);
  const Task task = next_task();
  EXPECT_EQ(task.work.as<IdentificationTask>().slot, yaw.slot);
  EXPECT_EQ(json::parse(get("/api/mode").body)["mode"], "identification");
  EXPECT_EQ(post("/api/proposals", R"({"slot":2,"target_counts":1})").problem()["code"], "MODE_PATH");
  EXPECT_EQ(audit("proposal").front()["asked"],
            json({{"kind", "identify"}, {"axis", "yaw"}, {"cleared", true}, {"mode", "identification"}}));
}

TEST_F(IdentificationRoutesTest, NothingIsMeasuredWhileThereMayBeAPatient) {
  for (const char* body :
       {R"({"kind":"identify","axis":"yaw"})", R"({"kind":"identify","axis":"yaw","cleared":false})",
        R"({"kind":"identify","axis":"elbow","cleared":true})", R"({"kind":"identify","cleared":true})"}) {
    expect_refused("INVALID", body);
  }
  ASSERT_EQ(post("/api/cases", R"({"label":"a patient"})").status, 201u);
  expect_refused("CASE");
  ASSERT_EQ(post("/api/cases/2/suspend").status, 200u);
  expect_refused("CASE");
  ASSERT_EQ(post("/api/cases/2/close").status, 200u);
  const json made = proposed();
  ASSERT_EQ(post("/api/proposals/" + made["id"].dump() + "/approve").status, 200u);
  ASSERT_EQ(post("/api/cases", R"({"label":"another"})").status, 201u);
  EXPECT_EQ(now_of(made)["state"], "aborted");
  EXPECT_EQ(now_of(made)["detail"],
            "A case was opened, or its registration, probe or target changed: there may be a patient now.");
  (void)next_task();
  EXPECT_EQ(std::get<Cancel>(next_command()).task, made["id"]);
}

TEST_F(IdentificationRoutesTest, NothingIsMeasuredUnlessTheProbeIsOutAndStaysOut) {
  const std::uint32_t insertion = test::neuro().with_role("insertion")->slot;
  const json made = proposed();
  test::move(view_, insertion, 40);
  show(view_);
  expect_refused("INSERTED");
  EXPECT_EQ(post("/api/proposals/" + made["id"].dump() + "/approve").problem()["code"], "STALE");
  view_.snapshot.state.axis[insertion].homed = 0;
  show(view_);
  expect_refused("NOT_HOMED");
}

TEST_F(IdentificationRoutesTest, AnAxisThatIsNotHomedOrEnabledIsNotMeasured) {
  ilk_axis_t& yaw = view_.snapshot.state.axis[test::neuro().find("yaw")->slot];
  yaw.homed = 0;
  show(view_);
  expect_refused("NOT_HOMED");
  yaw.homed = 1;
  yaw.state = ILK_AXIS_DISABLED;
  show(view_);
  expect_refused("DISABLED");
}

TEST_F(IdentificationRoutesTest, ALinkedSliderIsMeasuredWhereItsLinkageLetsIt) {
  const Robot& robot = test::neuro();
  const Axis& feet = *robot.find("feet");
  const Axis& head = *robot.find("head");
  const std::int32_t all =
      measuring_range(config_.axis[feet.slot], feet.lowest_setpoint_counts(), feet.highest_setpoint_counts())
          .way_counts;
  view_.snapshot.state.axis[feet.slot].position_counts = 0;
  view_.snapshot.state.axis[head.slot].position_counts = 0;
  show(view_);
  const json made =
      json::parse(post("/api/proposals", R"({"kind":"identify","axis":"feet","cleared":true})").body);
  ASSERT_EQ(made.value("state", ""), "checked") << made;
  AxisStates states = std::to_array(view_.snapshot.state.axis);
  for (const char* end : {"lowest_counts", "highest_counts"}) {
    states[feet.slot].position_counts = made[end];
    EXPECT_TRUE(check_separation(robot, states, 1u << feet.slot)) << end;
  }
  EXPECT_LE(made["highest_counts"].get<int>() - made["lowest_counts"].get<int>(),
            4 * all + 4 * static_cast<int>(feet.mechanics.coast_counts) + 4);
  view_.snapshot.state.axis[head.slot].homed = 0;
  show(view_);
  const json refused =
      json::parse(post("/api/proposals", R"({"kind":"identify","axis":"feet","cleared":true})").body);
  EXPECT_TRUE(refused["code"] == "SEPARATION" || refused["code"] == "RANGE") << refused;
}

TEST_F(IdentificationRoutesTest, WhatWasMeasuredIsAFileToLookAtAndTheRunningOneStays) {
  const json made = proposed();
  const std::string file = "/api/proposals/" + made["id"].dump() + "/robot-file";
  ASSERT_EQ(post("/api/proposals/" + made["id"].dump() + "/approve").status, 200u);
  EXPECT_EQ(get(file).problem()["code"], "NOT_MEASURED");
  report(made, TaskPhase::executing);
  EXPECT_EQ(get(file).problem()["code"], "NOT_MEASURED");
  EXPECT_EQ(now_of(made)["measured"]["speeds"].size(), 3u);
  report(made, TaskPhase::done);
  EXPECT_EQ(now_of(made)["measured"]["dead_zone_drive"], 4000);
  EXPECT_TRUE(now_of(made)["measured"]["hysteresis_counts"].is_null());
  const json change = json::parse(get(file).body);
  EXPECT_TRUE(change["problem"].is_null()) << change["problem"];
  const std::string was = test::neuro().text;
  const std::string text = change["text"];
  const std::string diff = change["diff"];
  EXPECT_NE(text, was);
  EXPECT_NE(text.find("dead_zone = 4000"), std::string::npos);
  EXPECT_TRUE(diff.starts_with("--- a/neuro.toml\n+++ b/neuro.toml\n@@ -")) << diff;
  EXPECT_NE(diff.find("\n-drive = { max = 0xEFFF, min = 0xFFF, dead_zone = 922, unhomed_max = 6143 }\n"),
            std::string::npos)
      << diff;
  EXPECT_EQ(change["changes"][1]["key"], "drive.dead_zone");
  EXPECT_EQ(test::neuro().text, was);
  EXPECT_EQ(get("/api/proposals/99/robot-file").status, 404u);
}

TEST_F(IdentificationRoutesTest, AFileThatTheKernelWouldRefuseIsNoFile) {
  const json made = proposed();
  ASSERT_EQ(post("/api/proposals/" + made["id"].dump() + "/approve").status, 200u);
  report(made, TaskPhase::executing);
  view_.measured.dead_zone_drive = 0.3 * 0xEFFF;
  view_.tasks.of<IdentificationTask>().phase = TaskPhase::done;
  show(view_);
  const json change = json::parse(get("/api/proposals/" + made["id"].dump() + "/robot-file").body);
  EXPECT_TRUE(change["text"].is_null());
  EXPECT_EQ(change["diff"], "");
  EXPECT_NE(change["problem"].get<std::string>().find("at most a fifth of drive.max"), std::string::npos)
      << change["problem"];
}

}  // namespace
}  // namespace interlock::web
