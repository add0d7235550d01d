#include "igtl/thesis.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace interlock::igtl {
namespace {

using testing::HasSubstr;

tl::expected<Command, Unwanted> command_of(const std::string& device, Body body) {
  return read_change({device, std::move(body), 0, 1, {}});
}

Matrix shifted(double x, double y, double z) { return {1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z, 0, 0, 0, 1}; }

TEST(Thesis, NamesAreTakenInUpperAndLowerCase) {
  for (const char* name : {"REGISTRATION", "Registration", "registration"}) {
    const auto command = command_of(name, Transform{shifted(1, 2, 3)});
    ASSERT_TRUE(command.has_value()) << name;
    EXPECT_EQ(std::get<SetRegistration>(*command).scanner_from_robot, shifted(1, 2, 3));
  }
}

TEST(Thesis, PoseOfAnImagerIsReportedAndNoMore) {
  const auto command = command_of("CURRENT_POSE", Transform{shifted(1, 2, 3)});
  EXPECT_TRUE(std::holds_alternative<ReportPose>(command.value()));
  EXPECT_TRUE(std::holds_alternative<Noted>(command_of("TIP_POSE", Transform{}).value()));
  EXPECT_TRUE(std::holds_alternative<Noted>(command_of("IMAGER_STATUS", Text{"scanning"}).value()));
  EXPECT_TRUE(std::holds_alternative<Noted>(command_of("IMAGER_STATUS", Status{}).value()));
}

/** What the dialect gives to be kept of a message. */
std::optional<ImagerWord> word_of(const std::string& device, Body body) {
  return Thesis().take({device, std::move(body), 0, 1, {}}, RobotState{}, false).word;
}

tl::expected<HoldMessage, Unwanted> hold_of(const std::string& device, const std::string& text) {
  return read_hold({device, Text{text}, 0, 1, {}}).value();
}

TEST(Holds, AreReadInUpperAndLowerCaseAndASignalSaysForHowLong) {
  using std::chrono::milliseconds;
  const auto open = std::get<GateSignal>(hold_of("BREATHING_GATE", "OPEN 2000").value());
  EXPECT_TRUE(open.open);
  EXPECT_EQ(open.validity, milliseconds(2000));
  const auto hold = std::get<GateSignal>(hold_of("breathing_gate", "hold").value());
  EXPECT_FALSE(hold.open);
  EXPECT_EQ(hold.validity, milliseconds(500));
  EXPECT_TRUE(std::get<ScanState>(hold_of("SCAN", "on").value()).active);
  EXPECT_FALSE(std::get<ScanState>(hold_of("Scan", "Off").value()).active);
}

TEST(Holds, WhatIsUnclearIsRefusedAndOpensNothing) {
  for (const char* text : {"", "open ", "open 49", "open 2001", "open -300", "open 1e3", "open 300 ",
                           "open  300", "opened", "closed", "open 99999999999999999999"}) {
    EXPECT_EQ(hold_of("BREATHING_GATE", text).error().code, StatusCode::configuration) << text;
  }
  EXPECT_THAT(hold_of("SCAN", "open").error().reason, HasSubstr("expected on or off"));
  EXPECT_FALSE(read_hold({"SCAN", Status{}, 0, 1, {}})) << "a STATUS only shows that its sender lives";
  EXPECT_FALSE(read_hold({"SCANNER", Text{"on"}, 0, 1, {}}));
}

TEST(Thesis, WordsOfAnImagerAreGivenToBeKept) {
  const auto tip = word_of("TIP_POSE", Transform{shifted(1, 2, 3)});
  EXPECT_EQ(std::get<TipPose>(tip.value()).scanner_from_tip, shifted(1, 2, 3));
  const auto text = std::get<ImagerStatus>(word_of("IMAGER_STATUS", Text{"scanning"}).value());
  EXPECT_FALSE(text.code);
  EXPECT_EQ(text.text, "scanning");
  const Status hot{StatusCode::hardware_failure, 0, "COIL", "too warm"};
  const auto status = std::get<ImagerStatus>(word_of("imager_status", hot).value());
  EXPECT_EQ(status.code, StatusCode::hardware_failure);
  EXPECT_EQ(status.name + ": " + status.text, "COIL: too warm");
  EXPECT_FALSE(word_of("KEEP_ALIVE", Status{})) << "a STATUS of another name is no word of an imager";
  EXPECT_FALSE(word_of("TIP_POSE", Transform{Matrix{}})) << "a refused pose is not kept";
}

TEST(Thesis, ATipPoseThatIsNoRigidMotionIsRefused) {
  const Matrix mirror{-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  const Matrix shear{1, 0.01, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  const Matrix twice{2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1};
  const Matrix coarse{1, 0.0002, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  for (const Matrix& wrong : {mirror, shear, twice, coarse, Matrix{}}) {
    EXPECT_EQ(command_of("TIP_POSE", Transform{wrong}).error().code, StatusCode::configuration);
  }
  const double angle = 0.3;
  const Matrix turned{std::cos(angle),
                      -std::sin(angle),
                      0,
                      5,
                      std::sin(angle),
                      std::cos(angle),
                      0,
                      6,
                      0,
                      0,
                      1,
                      7,
                      0,
                      0,
                      0,
                      1};
  EXPECT_TRUE(command_of("TIP_POSE", Transform{turned}).has_value());
}

TEST(Thesis, APointComesAsPointPositionOrPose) {
  const Position3 expected{4, 5, 6};
  const std::vector<Body> bodies{Points{{{"x", "", {}, expected, 0, ""}}}, Position{expected, std::nullopt},
                                 Transform{shifted(4, 5, 6)}};
  for (const Body& body : bodies) {
    const auto target = std::get<SetPoint>(command_of("TARGET_POINT", body).value());
    EXPECT_TRUE(target.is_target);
    EXPECT_EQ(target.position, expected);
    EXPECT_FALSE(std::get<SetPoint>(command_of("ENTRY_POINT", body).value()).is_target);
  }
  EXPECT_EQ(command_of("TARGET_POINT", Points{}).error().code, StatusCode::configuration);
  EXPECT_EQ(command_of("TARGET_POINT", Points{{{}, {}}}).error().code, StatusCode::configuration);
}

TEST(Thesis, OffsetsAreNumbersInWords) {
  const auto offset = std::get<SetOffset>(command_of("treatment_to_tip", Text{"-12.5"}).value());
  EXPECT_EQ(offset.field, "treatment_to_tip_offset");
  EXPECT_EQ(offset.mm, -12.5);
  EXPECT_EQ(std::get<SetOffset>(command_of("robot_treatment_home", Text{"3"}).value()).field,
            "treatment_to_robot_at_home");
  for (const char* wrong : {"", "x", "1,5", "1 ", "inf", "nan", "1e999"}) {
    EXPECT_FALSE(command_of("robot_to_entry", Text{wrong}).has_value()) << wrong;
  }
}

TEST(Thesis, TrajectoryHasRowsAndColumns) {
  const auto rows = std::get<LoadRows>(command_of("TRAJECTORY", Array{{2, 3}, {0, 1, 2, 3, 4, 5}}).value());
  EXPECT_EQ(rows.columns, 3u);
  EXPECT_EQ(rows.values.size(), 6u);
  EXPECT_THAT(command_of("TRAJECTORY", Array{{6}, {0, 1, 2, 3, 4, 5}}).error().reason,
              HasSubstr("1 dimensions"));
  EXPECT_THAT(command_of("TRAJECTORY", Transform{}).error().reason, HasSubstr("expected NDARRAY or TDATA"));
}

TEST(Thesis, TrajectoryOfPosesHasItsTimesAsNames) {
  const TrackingData data{{{"0", 2, shifted(1, 2, 3)}, {"0.25", 2, shifted(4, 5, 6)}}};
  const auto command = std::get<LoadPoses>(command_of("TRAJECTORY", data).value());
  ASSERT_EQ(command.poses.size(), 2u);
  EXPECT_EQ(command.poses[1].time_s, 0.25);
  EXPECT_EQ(command.poses[1].scanner_from_treatment, shifted(4, 5, 6));
  EXPECT_TRUE(needs_control(command));
  for (const char* wrong : {"", "tip", "1s", "nan", "inf", "1e999"}) {
    const auto refused = command_of("TRAJECTORY", TrackingData{{{"0", 2, {}}, {wrong, 2, {}}}});
    ASSERT_FALSE(refused.has_value()) << wrong;
    EXPECT_THAT(refused.error().reason, HasSubstr("row 2, name")) << wrong;
  }
}

TEST(Thesis, StopIsUnderstoodHoweverItIsSaid) {
  for (const char* word : {"STOP", "emergency"}) {
    const auto command = command_of("MODE", Text{word});
    ASSERT_TRUE(command.has_value()) << word;
    EXPECT_TRUE(std::holds_alternative<Stop>(*command)) << word;
    EXPECT_FALSE(needs_control(*command)) << "anybody may stop the robot";
  }
}

TEST(Thesis, NoSetpointIsTakenFromTheNetwork) {
  for (const char* name : {"servo_cp", "move_cp", "neuro/servo_jp", "NEURO/MOVE_JP", "servo_cf"}) {
    EXPECT_EQ(command_of(name, Transform{}).error().code, StatusCode::access_denied) << name;
  }
}

TEST(Thesis, AStatusIsNotAnsweredSoThatTwoProgramsDoNotAnswerEachOtherForEver) {
  EXPECT_FALSE(std::get<Noted>(command_of("", Status{}).value()).is_answered);
}

TEST(Thesis, UnknownNamesAreRefusedByName) {
  const auto refused = command_of("TARGET", Transform{});
  EXPECT_EQ(refused.error().code, StatusCode::unknown_instruction);
  EXPECT_THAT(refused.error().reason, HasSubstr("TARGET"));
}

TEST(Thesis, WhatChangesTheRobotIsTheControllersAlone) {
  for (const auto& [name, body] :
       std::vector<std::pair<const char*, Body>>{{"REGISTRATION", Transform{}},
                                                 {"CURRENT_POSE", Transform{}},
                                                 {"ENTRY_POINT", Transform{}},
                                                 {"robot_to_entry", Text{"1"}},
                                                 {"TRAJECTORY", Array{{1, 2}, {0, 0}}},
                                                 {"MODE", Text{"draping"}},
                                                 {"START_UP", Text{""}}}) {
    EXPECT_TRUE(needs_control(command_of(name, body).value())) << name;
  }
  EXPECT_FALSE(needs_control(command_of("", StartTracking{}).value()));
}

const Body* find(const Outgoings& messages, const std::string& name) {
  const auto found = std::ranges::find(messages, name, &Outgoing::first);
  return found == messages.end() ? nullptr : &found->second;
}

TEST(Thesis, WhatIsNotKnownIsNotSent) {
  const auto messages = messages_of({});
  for (const char* name : {"scanner_to_robot_reg", "measured_cp", "desired_cp", "entry_point", "target_point",
                           "measured_jp", "measured_jv"}) {
    EXPECT_EQ(find(messages, name), nullptr) << name;
  }
}

TEST(Thesis, EveryStateHasItsName) {
  RobotState state;
  state.scanner_from_robot = shifted(1, 0, 0);
  state.measured_cp = shifted(2, 0, 0);
  state.desired_cp = shifted(3, 0, 0);
  state.entry = Position3{4, 0, 0};
  state.target = Position3{5, 0, 0};
  state.treatment_to_tip_mm = 1.5;
  state.measured_jp = {0.25, -1e-9};
  state.measured_jv = {1, 2};
  state.desired_jp = {7, 8};
  const auto messages = messages_of(state);
  EXPECT_EQ(*find(messages, "registration_state"), Body(Text{"VALID"}));
  state.registration_problem = "The registration is not set.";
  EXPECT_EQ(*find(messages_of(state), "registration_state"), Body(Text{state.registration_problem}));
  EXPECT_EQ(*find(messages, "scanner_to_robot_reg"), Body(Transform{shifted(1, 0, 0)}));
  EXPECT_EQ(*find(messages, "measured_cp"), Body(Transform{shifted(2, 0, 0)}));
  EXPECT_EQ(*find(messages, "desired_cp"), Body(Transform{shifted(3, 0, 0)}));
  EXPECT_EQ(*find(messages, "setpoint_cp"), *find(messages, "desired_cp"));
  EXPECT_EQ(std::get<Points>(*find(messages, "entry_point")).points.at(0).position, (Position3{4, 0, 0}));
  EXPECT_EQ(std::get<Points>(*find(messages, "target_point")).points.at(0).position, (Position3{5, 0, 0}));
  EXPECT_EQ(*find(messages, "treatment_to_tip"), Body(Text{"1.5"}));
  EXPECT_EQ(*find(messages, "measured_jp"), Body(Text{"0.25,-1e-09"}));
  EXPECT_EQ(*find(messages, "desired_jp"), Body(Text{"7,8"}));
  EXPECT_EQ(*find(messages, "measured_jv"), Body(Text{"1,2"}));
  EXPECT_EQ(*find(messages, "measured_js"), Body(Array{{2, 2}, {0.25, -1e-9, 1, 2}}));
  EXPECT_EQ(tracking_of(state).tools.size(), 3u);
}

TEST(Thesis, AQueryIsAnsweredByNameOrByTypeAndNothingElseIsMadeUp) {
  Thesis dialect;
  RobotState state;
  state.scanner_from_robot = shifted(1, 0, 0);
  state.measured_cp = shifted(2, 0, 0);
  const auto ask = [&](const char* type, const char* device) {
    return dialect.take({device, Query{type}, 0, 1, {}}, state, true);
  };
  const Outgoings named = ask("TRANS", "measured_cp").replies;
  EXPECT_THAT(named, testing::ElementsAre(Outgoing("measured_cp", Transform{shifted(2, 0, 0)})));
  EXPECT_EQ(ask("TRANSFORM", "").replies.size(), 3u) << "registration and measured_cp, that as arm/, too";
  const Reaction none = ask("TRANS", "desired_cp");
  EXPECT_EQ(std::get<Status>(none.replies.at(0).second).code, StatusCode::not_found);
  EXPECT_THAT(none.refused, HasSubstr("desired_cp"));
  EXPECT_TRUE(std::holds_alternative<Capability>(ask("CAPABIL", "").replies.at(0).second));
  EXPECT_TRUE(std::holds_alternative<TrackingData>(ask("TDATA", "").replies.at(0).second));
}

TEST(Thesis, HomingIsAskedForAsInTheWorkphases) {
  for (const auto& [name, word] :
       {std::pair{"START_UP", ""}, {"MODE", "home"}, {"arm/state_command", "home"}}) {
    const auto command = command_of(name, Text{word});
    ASSERT_TRUE(command.has_value()) << name;
    EXPECT_TRUE(std::holds_alternative<StartUp>(*command)) << name;
    EXPECT_TRUE(needs_control(*command));
  }
}

TEST(Crtk, StateCommandsMoveNothingByThemselves) {
  for (const char* name : {"state_command", "arm/state_command", "PSM1/state_command"}) {
    EXPECT_TRUE(std::holds_alternative<Stop>(command_of(name, Text{"pause"}).value()));
    EXPECT_TRUE(std::holds_alternative<CutPower>(command_of(name, Text{"disable"}).value()));
    for (const char* refused : {"enable", "resume", "unhome"}) {
      EXPECT_EQ(command_of(name, Text{refused}).error().code, StatusCode::access_denied) << refused;
    }
    EXPECT_EQ(command_of(name, Text{"dance"}).error().code, StatusCode::unknown_instruction);
    EXPECT_EQ(command_of(name, Transform{}).error().code, StatusCode::configuration);
  }
}

TEST(Crtk, EachStateHasItsNameAndThatOfTheArm) {
  RobotState state;
  state.measured_cp = shifted(2, 0, 0);
  state.desired_cp = shifted(3, 0, 0);
  state.measured_cv = Spatial{1, 2, 3, 4, 5, 6};
  state.measured_cf = Spatial{0, 0, -1.5, 0, 0, 0};
  state.measured_jp = {0.25, 2};
  state.operating_state = "PAUSED";
  state.health = {StatusCode::ok, 0, "READY", "The kernel is in mode READY."};
  const std::vector<std::pair<std::string, Body>> expected{
      {"measured_cp", Transform{shifted(2, 0, 0)}},      {"setpoint_cp", Transform{shifted(3, 0, 0)}},
      {"measured_cv", Sensor{0, 0, {1, 2, 3, 4, 5, 6}}}, {"measured_cf", Sensor{0, 0, {0, 0, -1.5, 0, 0, 0}}},
      {"measured_js", Array{{1, 2}, {0.25, 2}}},         {"operating_state", Text{"PAUSED"}},
      {"status", Text{"The kernel is in mode READY."}}};
  const auto messages = messages_of(state);
  for (const auto& [name, body] : expected) {
    EXPECT_EQ(std::ranges::count(messages, name, &Outgoing::first), 1) << name;
    ASSERT_NE(find(messages, "arm/" + name), nullptr) << name;
    EXPECT_EQ(*find(messages, name), body) << name;
    EXPECT_EQ(*find(messages, "arm/" + name), body) << name;
  }
  EXPECT_EQ(find(messages, "error"), nullptr);
}

TEST(Crtk, ErrorsAndWarningsAreTexts) {
  RobotState state;
  state.health = {StatusCode::hardware_failure, 0, "LOCKED", "The kernel is locked."};
  const auto messages = messages_of(state);
  EXPECT_EQ(*find(messages, "error"), Body(Text{"The kernel is locked."}));
  EXPECT_EQ(find(messages, "status"), nullptr);
  EXPECT_EQ(find(messages, "measured_cf"), nullptr) << "no sensor";
  Thesis dialect;
  const auto follow = [&](StatusCode code, const char* word) {
    return dialect.follow({3, true, {code, 3, word, "Why."}}, {});
  };
  EXPECT_EQ(*find(follow(StatusCode::not_ready, "aborted"), "arm/warning"),
            Body(Text{"Proposal 3 is aborted. Why."}));
  EXPECT_EQ(*find(follow(StatusCode::ok, "done"), "status"), Body(Text{"Proposal 3 is done. Why."}));
}

TEST(Thesis, AWishIsAnsweredUnderItsOwnNameOnceItIsDone) {
  Thesis dialect;
  const Reaction reaction = dialect.take({"Mode", Text{"draping"}, 0, 1, {}}, {}, true);
  EXPECT_TRUE(reaction.replies.empty());
  ASSERT_TRUE(reaction.command.has_value());
  const Status status{StatusCode::not_ready, 0, "NO_KERNEL", "why"};
  EXPECT_THAT(dialect.finish("Mode", *reaction.command, {status}).replies,
              testing::ElementsAre(Outgoing("Mode", status)));
}

}  // namespace
}  // namespace interlock::igtl
