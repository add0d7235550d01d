#include "http_fixture.hpp"
#include "motion/setpoint_range.hpp"

namespace interlock::web {
namespace {

using test::insertion;
using test::neuro_config;

class JogRoutesTest : public HttpTest {
 protected:
  [[nodiscard]] static std::string begin(const std::string& direction) {
    return json{{"slot", insertion}, {"direction", direction}}.dump();
  }
};

TEST_F(JogRoutesTest, AJogIsAMoveToTheEndOfTheRangeInItsDirection) {
  const ControlView view = test::ready_view();
  show(view);
  const ilk_axis_t& axis = view.snapshot.state.axis[insertion];
  const SetpointRange range =
      setpoint_range(neuro_config().axis[insertion], axis, view.snapshot.state.system.mode);
  const Answered up = post("/api/jog", begin("increasing"));
  ASSERT_EQ(up.status, 201u) << up.body;
  EXPECT_EQ(json::parse(up.body)["target_counts"], range.highest_counts);
  EXPECT_EQ(next_task().work.as<MoveTask>().target_counts, range.highest_counts);
}

TEST_F(JogRoutesTest, AtItsEndAnAxisDoesNotJogBackwards) {
  ControlView view = test::ready_view();
  view.snapshot.state.axis[insertion].homed = 1;
  view.snapshot.state.axis[insertion].position_counts = neuro_config().axis[insertion].max_counts;
  show(view);
  const Answered answered = post("/api/jog", begin("increasing"));
  EXPECT_EQ(answered.status, 409u);
  EXPECT_EQ(answered.problem()["code"], "RANGE");
  Command command;
  EXPECT_FALSE(channel_->commands.pop(command));
}

TEST_F(JogRoutesTest, AJogIsHeldFromItsBeginAndEachRenewalSaysSince) {
  const ControlView view = test::ready_view();
  show(view);
  ASSERT_EQ(post("/api/jog", begin("increasing")).status, 201u);
  const auto approval = std::get<Approval>(next_command());
  ASSERT_TRUE(approval.task->work.as<MoveTask>().jog);
  EXPECT_EQ(approval.held.tick, view.snapshot.state.system.tick);
  EXPECT_EQ(put("/api/jog/" + std::to_string(approval.task->id), "").status, 200u);
  const auto renewal = std::get<Renewal>(next_command());
  EXPECT_EQ(renewal.task, approval.task->id);
  EXPECT_GE(renewal.held.time, approval.held.time);
}

TEST_F(JogRoutesTest, NobodyConsentsToMotionByAStateThatIsOld) {
  const std::string move = R"({"slot":3,"target_counts":1000})";
  show(test::ready_view(), std::chrono::milliseconds(251));
  for (const auto& [path, body] : {std::pair("/api/jog", begin("increasing")), {"/api/proposals", move}}) {
    const Answered refused = post(path, body);
    EXPECT_EQ(refused.status, 503u) << path;
    EXPECT_EQ(refused.problem()["code"], "NO_KERNEL") << path;
  }
  Command command;
  EXPECT_FALSE(channel_->commands.pop(command));
  show(test::ready_view(), std::chrono::milliseconds(250));
  EXPECT_EQ(post("/api/proposals", move).status, 201u);
}

TEST_F(JogRoutesTest, AMoveIsNotHeld) {
  show(test::ready_view());
  ASSERT_EQ(post("/api/proposals", R"({"slot":3,"target_counts":1000})").status, 201u);
  EXPECT_FALSE(next_task().work.as<MoveTask>().jog);
}

TEST_F(JogRoutesTest, AJogThatTheControlThreadHasEndedIsNotRenewed) {
  ControlView view = test::ready_view();
  show(view);
  ASSERT_EQ(post("/api/jog", begin("increasing")).status, 201u);
  const std::uint32_t id = next_task().id;
  view.tasks.move(insertion) = {id, TaskPhase::aborted, TaskReason::let_go, 0, 7};
  show(view);
  const Answered late = put("/api/jog/" + std::to_string(id), "");
  EXPECT_EQ(late.status, 409u);
  EXPECT_EQ(late.problem()["code"], "JOG_LAPSED");
}

TEST_F(JogRoutesTest, WhatIsNoJogIsNotRenewed) {
  show(test::ready_view());
  ASSERT_EQ(post("/api/proposals", R"({"slot":3,"target_counts":1000})").status, 201u);
  for (const char* path : {"/api/jog/1", "/api/jog/2", "/api/jog/x"}) {
    EXPECT_EQ(put(path, "").problem()["code"], "JOG_LAPSED") << path;
  }
}

TEST_F(JogRoutesTest, AWrongFieldIsNamed) {
  show(test::ready_view());
  EXPECT_EQ(post("/api/jog", R"({"slot":3,"direction":"up"})").problem()["field"], "direction");
  EXPECT_EQ(post("/api/jog", R"({"direction":"increasing"})").problem()["field"], "slot");
  EXPECT_EQ(post("/api/jog", R"({"slot":9,"direction":"increasing"})").status, 404u);
}

}  // namespace
}  // namespace interlock::web
