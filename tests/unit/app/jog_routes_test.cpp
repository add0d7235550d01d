#include "http/jog_desk.hpp"
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
  EXPECT_EQ(std::get<Order>(next_command()).target_counts, range.highest_counts);
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
  EXPECT_FALSE(mailbox_->commands.pop(command));
}

TEST_F(JogRoutesTest, AJogThatNobodyRenewsIsCancelled) {
  show(test::ready_view());
  const Answered begun = post("/api/jog", begin("increasing"));
  ASSERT_EQ(begun.status, 201u) << begun.body;
  const auto order = std::get<Order>(next_command());
  const std::string path = "/api/jog/" + std::to_string(order.proposal);
  EXPECT_EQ(put(path, "").status, 200u);
  pass(std::chrono::seconds(1));
  EXPECT_EQ(std::get<Cancel>(next_command()).proposal, order.proposal);
  const Answered late = put(path, "");
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
