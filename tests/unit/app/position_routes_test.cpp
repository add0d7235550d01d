#include <algorithm>

#include "http_fixture.hpp"

namespace interlock::web {
namespace {

using test::insertion;
using test::neuro;
using testing::HasSubstr;

class PositionRoutesTest : public HttpTest {
 protected:
  PositionRoutesTest() { show(test::ready_view()); }

  /** The saved file, once a kernel is seen. */
  json saved() { return json::parse(get("/api/positions").body); }

  static json restore(const json& file, const std::vector<std::string>& axes) {
    return {{"file", file}, {"axes", axes}};
  }

  static std::vector<const Axis*> without_switch() {
    std::vector<const Axis*> axes;
    for (const Axis& axis : neuro().axes) {
      if (axis.limit == ILK_LIMIT_NONE) {
        axes.push_back(&axis);
      }
    }
    return axes;
  }

  static json row_of(const json& rows, const Axis& axis) {
    return *std::ranges::find_if(rows, [&](const json& row) { return row["axis"] == axis.name; });
  }

  void expect_nothing_asked() {
    Command command;
    EXPECT_FALSE(channel_->commands.pop(command));
  }
};

TEST_F(PositionRoutesTest, SavedPositionsAreAFileWithAName) {
  const Answered answered = get("/api/positions");
  ASSERT_EQ(answered.status, 200u);
  EXPECT_THAT(std::string(answered.headers["Content-Disposition"]),
              testing::MatchesRegex("attachment; filename=\"neuro-positions-[0-9]+T[0-9]+Z\\.json\""));
  EXPECT_EQ(json::parse(answered.body)["axes"].size(), neuro().axes.size());
}

TEST_F(PositionRoutesTest, TheSetpointOfAnOpenMoveIsSavedWithIt) {
  ASSERT_EQ(post("/api/proposals", R"({"slot":3,"target_counts":1000})").status, 201u);
  const json file = saved();
  for (const json& axis : file.at("axes")) {
    const bool moves = axis["axis"] == neuro().at_slot(insertion)->name;
    EXPECT_EQ(axis["setpoint_counts"], moves ? json(1000) : json());
  }
}

TEST_F(PositionRoutesTest, ComparingShowsBothAndChangesNothing) {
  json file = saved();
  file["axes"][0]["position_counts"] = 1;
  const Answered answered = post("/api/positions/compare", file.dump());
  ASSERT_EQ(answered.status, 200u);
  const json row = json::parse(answered.body)["axes"][0];
  EXPECT_EQ(row["axis"], neuro().axes[0].name);
  EXPECT_EQ(row["saved_counts"], 1);
  EXPECT_EQ(row["now_counts"], test::ready_view().snapshot.state.axis[neuro().axes[0].slot].position_counts);
  expect_nothing_asked();
}

TEST_F(PositionRoutesTest, AForeignFileIsRefusedAndNothingIsRestored) {
  const std::pair<const char*, json> changes[] = {
      {"POSITIONS_VERSION", {{"version", 2}}},
      {"POSITIONS_ROBOT", {{"robot", "prostate"}}},
      {"POSITIONS_CONFIG", {{"config_crc", "00000000"}}},
  };
  for (const auto& [code, change] : changes) {
    json file = saved();
    file.update(change);
    const Answered compared = post("/api/positions/compare", file.dump());
    EXPECT_EQ(compared.status, 409u);
    EXPECT_EQ(compared.problem()["code"], code);
    const Answered restored = put("/api/motors/restore", restore(file, {neuro().axes[0].name}).dump());
    EXPECT_EQ(restored.status, 409u);
    EXPECT_EQ(restored.problem()["code"], code);
  }
  expect_nothing_asked();
}

TEST_F(PositionRoutesTest, AWrongWishIsNamedAndNothingIsRestored) {
  const std::string first = neuro().axes[0].name;
  json broken = saved();
  broken["axes"][1]["homed"] = 7;
  const std::pair<json, const char*> cases[] = {
      {restore(broken, {first}), "file.axes[1].homed"},
      {restore(saved(), {}), "axes"},
      {restore(saved(), {first, "elbow"}), "axes[1]"},
      {restore(saved(), {first, first}), "axes[0]"},
      {{{"axes", {first}}}, "file"},
      {{{"file", saved()}}, "axes"},
      {{{"file", saved()}, {"axes", first}}, "axes"},
      {{{"file", saved()}, {"axes", {first}}, {"enable", true}}, "enable"}};
  for (const auto& [body, field] : cases) {
    const Answered answered = put("/api/motors/restore", body.dump());
    EXPECT_EQ(answered.status, 422u) << body;
    EXPECT_EQ(answered.problem()["field"], field);
  }
  EXPECT_EQ(put("/api/motors/restore", "{\"file\":").problem()["code"], "MALFORMED");
  EXPECT_EQ(post("/api/positions/compare", saved().dump().substr(0, 40)).problem()["code"], "MALFORMED");
  expect_nothing_asked();
}

TEST_F(PositionRoutesTest, RestoringAsksForEachNamedAxisInTheOrderOfTheRobotAndReportsEachVerdict) {
  json file = saved();
  std::vector<std::string> names;
  for (const Axis& axis : neuro().axes) {
    names.push_back(axis.name);
  }
  const std::vector<std::string> desired{names[2], names[0]};
  for (json& axis : file["axes"]) {
    axis["position_counts"] = axis["axis"] == names[0] ? 11 : 22;
  }
  auto restoring = std::async(std::launch::async,
                              [&] { return put("/api/motors/restore", restore(file, desired).dump()); });
  const auto first = std::get<KernelCall>(next_command());
  EXPECT_EQ(first.kind, static_cast<std::uint32_t>(ILK_REQUEST_RESTORE));
  EXPECT_EQ(first.slot, neuro().axes[0].slot);
  EXPECT_EQ(first.target_counts, 11);
  answer(KernelResponse{first.call_id, ILK_VERDICT_BUSY, 5});
  const auto second = std::get<KernelCall>(next_command());
  EXPECT_EQ(second.slot, neuro().axes[2].slot);
  EXPECT_EQ(second.target_counts, 22);
  answer(KernelResponse{second.call_id, ILK_VERDICT_ACCEPTED, 6});
  const Answered answered = restoring.get();
  ASSERT_EQ(answered.status, 200u);
  const json rows = json::parse(answered.body);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0]["verdict"], "BUSY");
  EXPECT_FALSE(rows[0]["detail"].get<std::string>().empty());
  EXPECT_EQ(rows[1]["verdict"], "ACCEPTED");
  EXPECT_FALSE(rows[1].contains("detail"));
  expect_nothing_asked();
  EXPECT_EQ(audit("restore").at(0)["axes"], json({{names[0], 11}, {names[2], 22}}));
}

TEST_F(PositionRoutesTest, AKernelOfAnotherConfigurationRestoresNothing) {
  const json file = saved();
  ControlView other = test::ready_view();
  other.snapshot.config_crc ^= 1u;
  show(other);
  const Answered answered = put("/api/motors/restore", restore(file, {neuro().axes[0].name}).dump());
  EXPECT_EQ(answered.status, 409u);
  EXPECT_EQ(answered.problem()["code"], "CONFIG_MISMATCH");
  expect_nothing_asked();
}

TEST_F(PositionRoutesTest, ZeroAllAsksForEveryAxisWithoutASwitchInTheOrderOfTheRobot) {
  auto zeroing = std::async(std::launch::async, [this] { return post("/api/motors/zero-all"); });
  for (const Axis* axis : without_switch()) {
    const auto ask = std::get<KernelCall>(next_command());
    EXPECT_EQ(ask.kind, static_cast<std::uint32_t>(ILK_REQUEST_SET_HOME));
    EXPECT_EQ(ask.slot, axis->slot);
    answer(KernelResponse{ask.call_id, ILK_VERDICT_ACCEPTED, 5});
  }
  const Answered answered = zeroing.get();
  ASSERT_EQ(answered.status, 200u);
  const json rows = json::parse(answered.body);
  ASSERT_EQ(rows.size(), neuro().axes.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool has_switch = neuro().axes[i].limit != ILK_LIMIT_NONE;
    EXPECT_EQ(rows[i]["axis"], neuro().axes[i].name);
    EXPECT_EQ(rows[i]["verdict"].is_null(), has_switch);
    EXPECT_EQ(rows[i].value("detail", "").find("Not sent: it has a limit switch") == 0, has_switch);
  }
  expect_nothing_asked();
  EXPECT_EQ(audit("request").at(0)["what"], "every axis without a switch");
}

TEST_F(PositionRoutesTest, WhenTheKernelFallsSilentTheRestIsNotSent) {
  auto zeroing = std::async(std::launch::async, [this] { return post("/api/motors/zero-all"); });
  answer(KernelResponse{std::get<KernelCall>(next_command()).call_id, std::nullopt, 0});
  const json rows = json::parse(zeroing.get().body);
  EXPECT_THAT(row_of(rows, *without_switch()[0])["detail"].get<std::string>(), HasSubstr("did not answer"));
  EXPECT_THAT(row_of(rows, *without_switch()[1])["detail"].get<std::string>(),
              HasSubstr("Not sent: the kernel"));
  expect_nothing_asked();
}

TEST_F(PositionRoutesTest, WhoLosesControlMeanwhileSetsNoFurtherAxis) {
  const std::string admin = token_of("ada");
  auto zeroing = std::async(std::launch::async, [this] { return post("/api/motors/zero-all"); });
  const auto first = std::get<KernelCall>(next_command());
  EXPECT_EQ(as(admin, [this] { return post("/api/control/take-over"); }).status, 200u);
  answer(KernelResponse{first.call_id, ILK_VERDICT_ACCEPTED, 5});
  const json rows = json::parse(zeroing.get().body);
  EXPECT_EQ(row_of(rows, *without_switch()[0])["verdict"], "ACCEPTED");
  EXPECT_THAT(row_of(rows, *without_switch()[1])["detail"].get<std::string>(), HasSubstr("control"));
  expect_nothing_asked();
}

/** Declares the axes without a switch at home; the kernel accepts it, and shows them there. */
class DeclaredPositionsTest : public PositionRoutesTest {
 protected:
  DeclaredPositionsTest() : seen_(test::ready_view()) {
    for (const Axis* axis : without_switch()) {
      ilk_axis_t& state = seen_.snapshot.state.axis[axis->slot];
      state.position_counts = 700;
      state.raw = 4'000'000'000u;
      state.homed = ILK_HOMED_BY_SWITCH;
    }
    show(seen_);
    const json rows = answered(ILK_VERDICT_ACCEPTED, [this] { return post("/api/motors/zero-all"); });
    EXPECT_EQ(row_of(rows, *without_switch()[0])["verdict"], "ACCEPTED");
    for (const Axis* axis : without_switch()) {
      seen_.snapshot.state.axis[axis->slot].position_counts = 0;
      seen_.snapshot.state.axis[axis->slot].homed = ILK_HOMED_BY_HAND;
    }
    show(seen_);
  }

  /** The rows that somebody is given while the kernel answers each request by that verdict. */
  template <typename Asking>
  json answered(std::uint32_t verdict, Asking asking) {
    asked_.clear();
    auto answering = std::async(std::launch::async, asking);
    while (answering.wait_for(std::chrono::milliseconds(1)) != std::future_status::ready) {
      Command command;
      while (channel_->commands.pop(command)) {
        asked_.push_back(std::get<KernelCall>(command));
        answer(KernelResponse{asked_.back().call_id, verdict, 5});
      }
    }
    return json::parse(answering.get().body);
  }

  json undo(std::uint32_t verdict = ILK_VERDICT_ACCEPTED) {
    return answered(verdict, [this] { return post("/api/positions/undo"); });
  }

  /** The hand or the noise of the encoder moves the axis. */
  void move(const Axis& axis, std::int32_t counts) {
    ilk_axis_t& state = seen_.snapshot.state.axis[axis.slot];
    state.position_counts += counts;
    state.raw += static_cast<std::uint32_t>(axis.direction_correction != 0 ? -counts : counts);
    show(seen_);
  }

  ControlView seen_;
  std::vector<KernelCall> asked_;
};

TEST_F(DeclaredPositionsTest, AreShownWithWhatTheyWereBefore) {
  const json declared = json::parse(get("/api/positions/undo").body);
  EXPECT_EQ(declared["by"], "edna");
  EXPECT_EQ(declared["left_s"], 60);
  ASSERT_EQ(declared["axes"].size(), without_switch().size());
  const json axis = declared["axes"][0];
  EXPECT_EQ(axis["axis"], without_switch()[0]->name);
  EXPECT_EQ(axis["before_counts"], 700);
  EXPECT_EQ(axis["declared_counts"], 0);
  EXPECT_EQ(axis["homed_before"], "BY_SWITCH");
  EXPECT_EQ(axis["undoable"], true);
}

TEST_F(DeclaredPositionsTest, AreTakenBackByTheirPositionsAlone) {
  const json rows = undo();
  ASSERT_EQ(asked_.size(), without_switch().size());
  for (std::size_t i = 0; i < asked_.size(); ++i) {
    EXPECT_EQ(asked_[i].kind, static_cast<std::uint32_t>(ILK_REQUEST_RESTORE));
    EXPECT_EQ(asked_[i].slot, without_switch()[i]->slot);
    EXPECT_EQ(asked_[i].target_counts, 700);
    EXPECT_EQ(rows[i]["verdict"], "ACCEPTED");
  }
  EXPECT_EQ(json::parse(get("/api/positions/undo").body), json());
  EXPECT_EQ(audit("request").at(1)["what"], "undo");
}

TEST_F(DeclaredPositionsTest, AreNotTakenBackOfAnAxisThatMoved) {
  const Axis& moved = *without_switch()[0];
  const auto noise = static_cast<std::int32_t>(config_.axis[moved.slot].noise_counts);
  move(moved, noise);
  EXPECT_EQ(json::parse(get("/api/positions/undo").body)["axes"][0]["undoable"], true);
  move(moved, 1);
  EXPECT_EQ(json::parse(get("/api/positions/undo").body)["axes"][0]["undoable"], false);
  const json rows = undo();
  EXPECT_THAT(row_of(rows, moved)["detail"].get<std::string>(), HasSubstr("it moved"));
  ASSERT_EQ(asked_.size(), without_switch().size() - 1);
  EXPECT_NE(asked_[0].slot, moved.slot);
}

TEST_F(DeclaredPositionsTest, AreNotTakenBackWhereAnotherOneFollowed) {
  for (const Axis* axis : without_switch()) {
    seen_.snapshot.state.axis[axis->slot].homed = ILK_HOMED_BY_SWITCH;
  }
  show(seen_);
  undo();
  EXPECT_TRUE(asked_.empty());
}

TEST_F(DeclaredPositionsTest, MayBeTakenBackAgainWhereTheKernelRefusedIt) {
  EXPECT_EQ(undo(ILK_VERDICT_BUSY)[0]["verdict"], "BUSY");
  EXPECT_EQ(undo()[0]["verdict"], "ACCEPTED");
}

TEST_F(DeclaredPositionsTest, AreTakenBackForAMinute) {
  pass(std::chrono::seconds(59));
  EXPECT_EQ(json::parse(get("/api/positions/undo").body)["left_s"], 1);
  pass(std::chrono::seconds(1));
  EXPECT_EQ(json::parse(get("/api/positions/undo").body), json());
  const Answered refused = post("/api/positions/undo");
  EXPECT_EQ(refused.status, 409u);
  EXPECT_EQ(refused.problem()["code"], "NOTHING_TO_UNDO");
  expect_nothing_asked();
}

TEST_F(PositionRoutesTest, ASetHomeOfOneAxisCanBeTakenBackAndARefusedOneCannot) {
  for (const std::uint32_t verdict : {ILK_VERDICT_BUSY, ILK_VERDICT_ACCEPTED}) {
    const std::string path = "/api/motors/" + without_switch()[0]->name + "/set-home";
    auto declaring = std::async(std::launch::async, [&] { return post(path); });
    answer(KernelResponse{std::get<KernelCall>(next_command()).call_id, verdict, 5});
    declaring.get();
    EXPECT_EQ(json::parse(get("/api/positions/undo").body).is_null(), verdict != ILK_VERDICT_ACCEPTED);
  }
}

TEST_F(PositionRoutesTest, WithoutAKernelNothingIsSavedComparedOrSet) {
  const json file = saved();
  show(ControlView{});
  EXPECT_EQ(get("/api/positions").problem()["code"], "NO_KERNEL");
  EXPECT_EQ(post("/api/positions/compare", file.dump()).problem()["code"], "NO_KERNEL");
  EXPECT_EQ(put("/api/motors/restore", restore(file, {neuro().axes[0].name}).dump()).status, 503u);
  EXPECT_EQ(post("/api/motors/zero-all").status, 503u);
  EXPECT_EQ(get("/api/positions/undo").status, 503u);
  EXPECT_EQ(post("/api/positions/undo").status, 503u);
  expect_nothing_asked();
}

TEST_F(PositionRoutesTest, ThePathsOfSeveralAxesAreNoAxes) {
  EXPECT_EQ(get("/api/motors/zero-all").headers[http::field::allow], "POST");
  EXPECT_EQ(get("/api/motors/restore").headers[http::field::allow], "PUT");
}

}  // namespace
}  // namespace interlock::web
