#include "http_fixture.hpp"

namespace interlock::web {
namespace {

using test::insertion;
using test::neuro;
using test::rotation;

using MotorRoutesTest = HttpTest;

TEST_F(MotorRoutesTest, AnAxisIsNamedBySlotOrByName) {
  show(test::ready_view());
  const json by_slot = json::parse(get("/api/motors/3").body);
  const json by_name = json::parse(get("/api/motors/" + neuro().at_slot(insertion)->name).body);
  EXPECT_EQ(by_slot["name"], neuro().at_slot(insertion)->name);
  EXPECT_EQ(by_slot, by_name);
  EXPECT_EQ(get("/api/motors/elbow").status, 404u);
}

TEST_F(MotorRoutesTest, AnAxisSaysWhetherItHomesAndHasASwitch) {
  show(test::ready_view());
  for (const json& motor : json::parse(get("/api/motors").body)) {
    const Axis& axis = *neuro().find(motor["name"].get<std::string>());
    EXPECT_EQ(motor["homing"], false);
    EXPECT_EQ(motor["has_switch"], axis.limit != ILK_LIMIT_NONE);
  }
}

TEST_F(MotorRoutesTest, AnActionByNameReachesTheSlot) {
  show(test::ready_view());
  const std::string path = "/api/motors/" + neuro().at_slot(insertion)->name + "/enable";
  auto enabling = std::async(std::launch::async, [&] { return post(path); });
  const auto ask = std::get<KernelCall>(next_command());
  EXPECT_EQ(ask.slot, insertion);
  answer(KernelResponse{ask.call_id, ILK_VERDICT_ACCEPTED, 7});
  EXPECT_EQ(json::parse(enabling.get().body)["tick"], 7);
}

TEST_F(MotorRoutesTest, AnAxisWithoutASwitchIsDeclaredAtHome) {
  show(test::ready_view());
  auto declaring = std::async(std::launch::async, [this] { return post("/api/motors/1/set-home"); });
  const auto ask = std::get<KernelCall>(next_command());
  EXPECT_EQ(ask.kind, static_cast<std::uint32_t>(ILK_REQUEST_SET_HOME));
  EXPECT_EQ(ask.slot, rotation);
  answer(KernelResponse{ask.call_id, ILK_VERDICT_ACCEPTED, 7});
  EXPECT_EQ(declaring.get().status, 200u);
  EXPECT_EQ(audit("request").at(0)["what"], neuro().at_slot(rotation)->name + " set-home");
}

TEST_F(MotorRoutesTest, AnAxisWithASwitchIsNotDeclaredAtHomeUnawares) {
  show(test::ready_view());
  for (const char* body : {"", "{}", R"({"override_switch":false})"}) {
    const Answered answered = post("/api/motors/3/set-home", body);
    EXPECT_EQ(answered.status, 409u);
    EXPECT_EQ(answered.problem()["code"], "HAS_SWITCH");
    EXPECT_FALSE(answered.problem()["next_step"].get<std::string>().empty());
  }
  EXPECT_EQ(post("/api/motors/3/set-home", "{").status, 400u);
  EXPECT_EQ(post("/api/motors/3/set-home", R"({"override_switch":"yes"})").status, 422u);
  EXPECT_EQ(post("/api/motors/3/enable", R"({"override_switch":"yes"})").status, 422u);
  EXPECT_EQ(post("/api/motors/3/set-home", R"({"override":true})").status, 422u);
  Command command;
  EXPECT_FALSE(channel_->commands.pop(command));
  EXPECT_TRUE(audit("request").empty());
}

TEST_F(MotorRoutesTest, WhoOverridesASwitchIsInTheAudit) {
  show(test::ready_view());
  auto declaring = std::async(
      std::launch::async, [this] { return post("/api/motors/3/set-home", R"({"override_switch":true})"); });
  const auto ask = std::get<KernelCall>(next_command());
  EXPECT_EQ(ask.kind, static_cast<std::uint32_t>(ILK_REQUEST_SET_HOME));
  EXPECT_EQ(ask.slot, insertion);
  answer(KernelResponse{ask.call_id, ILK_VERDICT_ACCEPTED, 7});
  EXPECT_EQ(declaring.get().status, 200u);
  EXPECT_EQ(audit("request").at(0)["what"],
            neuro().at_slot(insertion)->name + " set-home, its switch overridden");
}

TEST_F(MotorRoutesTest, HomingIsAProposalAndNoAction) {
  show(test::ready_view());
  EXPECT_EQ(post("/api/motors/3/home").status, 404u);
  Command command;
  EXPECT_FALSE(channel_->commands.pop(command));
}

TEST_F(MotorRoutesTest, StatusShowsAllTenSlots) {
  ControlView view = test::ready_view();
  view.snapshot.state.axis[insertion].card_valid = 0;
  view.snapshot.state.axis[insertion].heartbeat = 77;
  view.snapshot.state.axis[insertion].checksum_failures = 3;
  show(view);
  const json cards = json::parse(get("/api/status").body)["cards"];
  ASSERT_EQ(cards.size(), static_cast<std::size_t>(ILK_SLOTS));
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    const bool has_axis = neuro().at_slot(slot) != nullptr;
    EXPECT_EQ(cards[slot]["slot"], slot);
    EXPECT_EQ(cards[slot]["card"] == "NONE", test::neuro_config().axis[slot].card == ILK_CARD_NONE);
    if (has_axis) {
      EXPECT_EQ(cards[slot]["detected"], true);
      EXPECT_EQ(cards[slot]["heartbeat_live"], slot != insertion);
    }
  }
  EXPECT_EQ(cards[insertion]["heartbeat"], 77);
  EXPECT_EQ(cards[insertion]["checksum_failures"], 3);
}

TEST_F(MotorRoutesTest, StatusTellsHowLongTheLastValidFrameOfEachCardLiesBack) {
  ControlView view = test::ready_view();
  view.snapshot.state.system.tick = 5000;
  view.snapshot.state.axis[test::yaw].bad_frames = 0;
  view.snapshot.state.axis[insertion].bad_frames = 40;
  view.snapshot.state.axis[test::rotation].bad_frames = 5000;
  view.snapshot.state.axis[test::empty_slot].bad_frames = 40;
  show(view);
  const json cards = json::parse(get("/api/status").body)["cards"];
  EXPECT_EQ(cards[test::yaw]["frame_age_ms"], 0.0);
  EXPECT_EQ(cards[insertion]["frame_age_ms"], 40 * test::neuro_config().common.period_us / 1000.0);
  EXPECT_TRUE(cards[test::rotation]["frame_age_ms"].is_null()) << "none since the kernel started";
  EXPECT_TRUE(cards[test::empty_slot]["frame_age_ms"].is_null());
}

}  // namespace
}  // namespace interlock::web
