#include "http_fixture.hpp"
#include "targeting/guide_frame.hpp"
#include "targeting/registration.hpp"

namespace interlock::web {
namespace {

using test::needle_view;
using test::prostate;

json list(const Eigen::Vector3d& point) { return {point.x(), point.y(), point.z()}; }

class BiopsyRoutesTest : public HttpTest {
 protected:
  BiopsyRoutesTest() : HttpTest(prostate(), test::prostate_config()) { show(needle_view()); }

  Answered show_image(const json& body) { return post("/api/biopsy/images", body.dump()); }

  /** The guide frame where the needle is, with the robot turned and moved in the scanner. */
  [[nodiscard]] static Pose scanner_from_guide() {
    AxisPositions positions;
    for (const Axis& axis : prostate().axes) {
      positions.push_back(axis.to_unit(needle_view().snapshot.state.axis[axis.slot].position_counts));
    }
    const auto kinematics = RobotKinematics::create(prostate());
    return Registration::create(registration).value().scanner_from_zframe() *
           zframe_from_guide(prostate(), *kinematics, positions).value();
  }

  /** Registers the robot, and sets that point of the guide frame as the target. */
  void set_target(const Eigen::Vector3d& guide_mm) {
    register_robot(registration);
    const json target{{"target_point", list(scanner_from_guide() * guide_mm)}};
    ASSERT_EQ(put("/api/targeting/target", target.dump()).status, 200u);
  }

  void expect_refused(const Answered& answered, unsigned status, const std::string& code) {
    EXPECT_EQ(answered.status, status) << answered.body;
    EXPECT_EQ(answered.problem()["code"], code) << answered.body;
  }

  static constexpr RowMajor registration{0, -1, 0, 10.5, 1, 0, 0, -20, 0, 0, 1, 30, 0, 0, 0, 1};
};

const json in_guide_frame{{"kind", "biopsy"}, {"target_mm", {3.0, -2.0, 70.0}}};

TEST_F(BiopsyRoutesTest, ATargetInTheGuideFrameBecomesAnOrder) {
  const Answered made = propose(in_guide_frame);
  ASSERT_EQ(made.status, 201u) << made.body;
  const json body = json::parse(made.body);
  EXPECT_EQ(body["target_mm"], in_guide_frame["target_mm"]);
  EXPECT_FALSE(body.contains("target_point"));
  EXPECT_EQ(next_task().id, body["id"]);
  EXPECT_EQ(json::parse(get("/api/biopsy").body)["open"], true);
}

TEST_F(BiopsyRoutesTest, TheTargetOfTheTargetingIsSeenFromTheNeedleByRegistrationAndEncoders) {
  set_target({3.0, -2.0, 70.0});
  const Answered made = propose({{"kind", "biopsy"}});
  ASSERT_EQ(made.status, 201u) << made.body;
  const json body = json::parse(made.body);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(body["target_mm"][axis].get<double>(), in_guide_frame["target_mm"][axis].get<double>(), 1e-6);
    EXPECT_NEAR(body["target_point"][axis].get<double>(),
                (scanner_from_guide() * Eigen::Vector3d(3.0, -2.0, 70.0))(axis), 1e-6);
  }
}

TEST_F(BiopsyRoutesTest, WhatTheTargetingCannotTellIsRefusedByName) {
  expect_refused(propose({{"kind", "biopsy"}}), 409, "NO_REGISTRATION");
  register_robot();
  expect_refused(propose({{"kind", "biopsy"}}), 409, "NO_TARGET");
  // A needle of 0.0041 per mm gets 10 mm aside within 70 mm.
  set_target({12.0, 0.0, 70.0});
  expect_refused(propose({{"kind", "biopsy"}}), 409, "UNREACHABLE");
  set_target({0.0, 0.0, -5.0});
  expect_refused(propose({{"kind", "biopsy"}}), 409, "UNREACHABLE");
  set_target({9.0, 0.0, 70.0});
  ControlView view = needle_view();
  view.snapshot.state.axis[prostate().find("back_left")->slot].homed = 0;
  show(view);
  expect_refused(propose({{"kind", "biopsy"}}), 409, "NO_REGISTRATION");
  set_target({9.0, 0.0, 70.0});
  expect_refused(propose({{"kind", "biopsy"}}), 409, "NOT_HOMED");
  show(needle_view());
  EXPECT_EQ(propose({{"kind", "biopsy"}}).status, 201u);
}

TEST_F(BiopsyRoutesTest, ABiopsyAtATargetEndsWhenTheTargetChangesAndOneInTheGuideFrameDoesNot) {
  set_target({3.0, -2.0, 70.0});
  ASSERT_EQ(propose({{"kind", "biopsy"}}).status, 201u);
  (void)next_command();
  set_target({2.0, -2.0, 70.0});
  EXPECT_EQ(json::parse(get("/api/proposals/1").body)["state"], "aborted");
  EXPECT_EQ(std::get<Cancel>(next_command()).task, 1u);
  ASSERT_EQ(propose(in_guide_frame).status, 201u);
  set_target({3.0, -2.0, 70.0});
  EXPECT_EQ(json::parse(get("/api/proposals/2").body)["state"], "approved");
}

TEST_F(BiopsyRoutesTest, AnImageIsHandedOnInTheTimeAndFrameOfItsBiopsy) {
  set_target({3.0, -2.0, 70.0});
  ASSERT_EQ(propose({{"kind", "biopsy"}}).status, 201u);
  (void)next_command();
  ControlView view = needle_view();
  view.snapshot.state.system.tick += 2500;
  show(view);
  const Eigen::Vector3d tip(0.5, 0.25, 10.0);
  const json image{{"frame", "scanner"}, {"tip_mm", list(scanner_from_guide() * tip)}, {"age_ms", 1000}};
  ASSERT_EQ(show_image(image).status, 200u);
  const auto seen = std::get<SeenImage>(next_command());
  EXPECT_EQ(seen.task, 1u);
  EXPECT_NEAR(seen.image.time_s, 1.5, 1e-9);
  EXPECT_LT((seen.image.tip_mm - tip).norm(), 1e-6);
  EXPECT_FALSE(seen.image.target_mm);
  ASSERT_EQ(show_image({{"tip_mm", {1, 2, 3}}, {"target_mm", {3, -2, 71}}, {"age_ms", 0}}).status, 200u);
  const auto plain = std::get<SeenImage>(next_command());
  EXPECT_EQ(plain.image.tip_mm, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(plain.image.target_mm, Eigen::Vector3d(3, -2, 71));
}

TEST_F(BiopsyRoutesTest, AnImageThatNobodyCanPlaceIsRefused) {
  const json in_scanner{{"frame", "scanner"}, {"tip_mm", {0, 0, 0}}, {"age_ms", 5}};
  expect_refused(show_image(in_scanner), 409, "NO_BIOPSY");
  ASSERT_EQ(propose(in_guide_frame).status, 201u);
  expect_refused(show_image(in_scanner), 409, "NO_FRAME");
  const std::pair<json, std::string> cases[] = {{{{"age_ms", 5}}, "tip_mm"},
                                                {{{"tip_mm", {0, 0}}, {"age_ms", 5}}, "tip_mm"},
                                                {{{"tip_mm", {0, 0, "up"}}, {"age_ms", 5}}, "tip_mm[2]"},
                                                {{{"tip_mm", {0, 0, 0}}}, "age_ms"},
                                                {{{"tip_mm", {0, 0, 0}}, {"age_ms", -1}}, "age_ms"},
                                                {{{"tip_mm", {0, 0, 0}}, {"age_ms", 60001}}, "age_ms"},
                                                {{{"frame", "robot"}}, "frame"}};
  for (const auto& [body, field] : cases) {
    const Answered refused = show_image(body);
    EXPECT_EQ(refused.status, 422u) << body;
    EXPECT_EQ(refused.problem()["field"], field) << body;
  }
}

TEST_F(BiopsyRoutesTest, MembranesAreSetWholeOrNotAtAll) {
  const std::pair<const char*, const char*> cases[] = {
      {R"({})", "depths_mm"},
      {R"({"depths_mm":5})", "depths_mm"},
      {R"({"depths_mm":[20,20]})", "depths_mm[1]"},
      {R"({"depths_mm":[0]})", "depths_mm[0]"},
      {R"({"depths_mm":[20,500.5]})", "depths_mm[1]"},
      {R"({"depths_mm":[20,"deep"]})", "depths_mm[1]"},
      {R"({"depths_mm":[1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17]})", "depths_mm"},
      {R"({"depths_mm":[20],"next":2})", "next"},
      {R"({"depths_mm":[20],"next":-1})", "next"}};
  const json named = put("/api/biopsy/membranes", R"({"depths_mm":[20,"deep"]})").problem();
  EXPECT_EQ(named["detail"], R"(depths_mm[1] is "deep".)");
  EXPECT_EQ(named["expected"], "a number above 20.0, up to 500: below the one before");
  const json before = json::parse(get("/api/biopsy").body)["membranes"];
  for (const auto& [body, field] : cases) {
    const Answered refused = put("/api/biopsy/membranes", body);
    EXPECT_EQ(refused.status, 422u) << body;
    EXPECT_EQ(refused.problem()["field"], field) << body;
  }
  EXPECT_EQ(json::parse(get("/api/biopsy").body)["membranes"], before);
  EXPECT_TRUE(audit("setting").empty());
  const Answered changed = put("/api/biopsy/membranes", R"({"depths_mm":["20",30],"next":1})");
  ASSERT_EQ(changed.status, 200u) << changed.body;
  EXPECT_EQ(json::parse(changed.body)["left"], 1);
  ASSERT_EQ(audit("setting").size(), 1u);
  EXPECT_EQ(audit("setting")[0]["membranes_mm"], json({20.0, 30.0}));
}

TEST_F(BiopsyRoutesTest, NothingThatAnOpenBiopsyWorksWithChanges) {
  ASSERT_EQ(propose(in_guide_frame).status, 201u);
  expect_refused(put("/api/biopsy/membranes", R"({"depths_mm":[20]})"), 409, "BIOPSY_OPEN");
  expect_refused(post("/api/biopsy/membranes/reset"), 409, "BIOPSY_OPEN");
  expect_refused(post("/api/biopsy/zero"), 409, "BIOPSY_OPEN");
  EXPECT_EQ(json::parse(get("/api/biopsy").body)["hand"]["zero_counts"], 1970.0);
}

TEST_F(BiopsyRoutesTest, ZeroingAnswersWithTheNewZeroesAndNeedsControl) {
  show(needle_view(1990, 1790));
  const Answered zeroed = post("/api/biopsy/zero");
  ASSERT_EQ(zeroed.status, 200u) << zeroed.body;
  EXPECT_EQ(json::parse(zeroed.body)["hand"]["zero_counts"], 1990.0);
  EXPECT_EQ(audit("setting").back()["force"], "zero");
  log_in("vic");
  EXPECT_EQ(post("/api/biopsy/zero").status, 403u);
  log_in("ada");
  expect_refused(post("/api/biopsy/zero"), 409, "CONTROL");
}

class NoNeedleTest : public HttpTest {};

TEST_F(NoNeedleTest, ARobotWithoutANeedleHasNoBiopsy) {
  show(test::ready_view());
  EXPECT_EQ(get("/api/biopsy").status, 404u);
  EXPECT_EQ(put("/api/biopsy/membranes", R"({"depths_mm":[20]})").status, 404u);
  EXPECT_EQ(post("/api/biopsy/membranes/reset").status, 404u);
  EXPECT_EQ(post("/api/biopsy/zero").status, 404u);
  EXPECT_EQ(post("/api/biopsy/images", R"({"tip_mm":[0,0,0],"age_ms":0})").status, 404u);
  EXPECT_EQ(post("/api/proposals", in_guide_frame.dump()).status, 404u);
  EXPECT_EQ(post("/api/proposals", R"({"kind":"biopsy"})").status, 404u);
}

}  // namespace
}  // namespace interlock::web
