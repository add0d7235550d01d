#include "igtl/workphases.hpp"

#include <gmock/gmock.h>

namespace interlock::igtl {
namespace {

using testing::HasSubstr;
using namespace std::chrono_literals;

constexpr const char* dialect_names[] = {"brp2013", "wpi2024"};

Matrix moved(double x) { return {1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; }

/** How an answer begins: "CURRENT_STATUS 1 PLANNING", "ACK_7 STRING", "TARGET TRANSFORM". */
std::string short_of(const Outgoing& message) {
  if (const auto* status = std::get_if<Status>(&message.second)) {
    const bool names_phase = message.first == "CURRENT_STATUS";
    return message.first + " " + std::to_string(static_cast<int>(status->code)) +
           (names_phase ? " " + status->name : "");
  }
  return message.first + " " + type_of(message.second);
}

std::vector<std::string> shorts(const Outgoings& messages) {
  std::vector<std::string> result;
  for (const Outgoing& message : messages) {
    result.push_back(short_of(message));
  }
  return result;
}

using Shorts = std::vector<std::string>;

/** A connection in one of the dialects, whose controller it is; commands are granted at once. */
class Talk {
 public:
  explicit Talk(const char* dialect) : dialect_(make_dialect(dialect)) {
    state.measured_cp = moved(1);
    state.desired_cp = moved(2);
    state.health = {StatusCode::ok, 0, "READY", ""};
    state.is_probe_out = true;
  }

  /** What is answered at once. */
  Shorts send(const std::string& device, Body body, bool controls = true) {
    reaction = dialect_->take({device, std::move(body), 0, 1, {}}, state, controls);
    return shorts(reaction.replies);
  }

  Shorts ask(const std::string& phase, bool controls = true) { return send("CMD_7", Text{phase}, controls); }

  /** What is answered once the command was carried out. */
  Shorts done(Outcome outcome = {{StatusCode::ok, 0, "OK", ""}}) {
    const Command command = reaction.command.value();
    reaction = dialect_->finish("", command, outcome);
    return shorts(reaction.replies);
  }

  Shorts proposed(std::uint32_t number) {
    Outcome outcome{{StatusCode::ok, 0, "OK", ""}};
    outcome.proposal = number;
    return done(outcome);
  }

  Shorts refused(StatusCode code, std::int64_t sub_code = 0) {
    return done({{code, sub_code, "REFUSED", "why"}});
  }

  Shorts stored(double reachable = 2) {
    Outcome outcome{{StatusCode::ok, 0, "OK", ""}};
    outcome.target = moved(2);
    outcome.reachable = moved(reachable);
    return done(outcome);
  }

  Shorts over(std::uint32_t proposal, StatusCode code = StatusCode::ok) {
    return shorts(dialect_->follow({proposal, true, {code, proposal, "done", ""}}, state));
  }

  Shorts due(std::chrono::milliseconds after, bool has_to_hear = false) {
    return shorts(dialect_->heartbeat(Dialect::Time(after), state, has_to_hear));
  }

  /** Up to a stored target. */
  void target() {
    ask("START_UP");
    done();
    ask("CALIBRATION");
    send("CLB_1", Transform{moved(5)});
    stored();
    ask("PLANNING");
    ask("TARGETING");
    send("TGT_1", Transform{moved(2)});
    stored();
  }

  RobotState state;
  Reaction reaction;

 private:
  std::unique_ptr<Dialect> dialect_;
};

class EachDialect : public testing::TestWithParam<const char*> {
 protected:
  Talk talk{GetParam()};
};

INSTANTIATE_TEST_SUITE_P(Workphases, EachDialect, testing::ValuesIn(dialect_names),
                         [](const auto& each) { return std::string(each.param); });

TEST_P(EachDialect, AcknowledgesWithTheSameIdAndTextThenTellsThePhase) {
  EXPECT_EQ(talk.send("CMD_0123456789abcdef", Text{"START_UP"}),
            (Shorts{"ACK_0123456789abcdef STRING", "CURRENT_STATUS 1 START_UP"}));
  EXPECT_EQ(std::get<Text>(talk.reaction.replies[0].second).text, "START_UP");
  EXPECT_TRUE(std::holds_alternative<StartUp>(talk.reaction.command.value()));
  EXPECT_EQ(talk.done(), Shorts{"START_UP 1"});
}

TEST_P(EachDialect, ARequestThatComesAgainUnderItsIdIsAcknowledgedAndNotCarriedOutAgain) {
  talk.target();
  talk.send("CMD_2", Text{"MOVE_TO_TARGET"});
  talk.proposed(4);
  EXPECT_EQ(talk.send("CMD_2", Text{"MOVE_TO_TARGET"}),
            (Shorts{"ACK_2 STRING", "CURRENT_STATUS 1 MOVE_TO_TARGET"}));
  EXPECT_FALSE(talk.reaction.command.has_value());
  EXPECT_FALSE(talk.reaction.ends.has_value()) << "the motion that it became goes on";
  EXPECT_THAT(talk.reaction.refused, HasSubstr("same request"));
  EXPECT_EQ(talk.send("TGT_1", Transform{moved(2)}),
            (Shorts{"ACK_1 TRANSFORM", "CURRENT_STATUS 1 MOVE_TO_TARGET"}));
  EXPECT_EQ(talk.reaction.replies[0].second, Body(Transform{moved(2)})) << "its exact echo";
  EXPECT_FALSE(talk.reaction.command.has_value());
  EXPECT_EQ(talk.over(4), Shorts({"MOVE_TO_TARGET 1", "CURRENT_POSITION TRANSFORM"}));
}

TEST_P(EachDialect, AnotherRequestUnderAnIdThatWasUsedIsANewOne) {
  talk.ask("START_UP");
  talk.done();
  talk.ask("CALIBRATION");
  talk.send("CLB_1", Transform{moved(5)});
  talk.stored();
  talk.send("CLB_1", Transform{moved(6)});
  EXPECT_TRUE(talk.reaction.command.has_value());
}

TEST_P(EachDialect, ATargetThatWasRefusedMayBeSentAgainUnderTheSameId) {
  talk.target();
  for (int time = 0; time < 2; ++time) {
    talk.send("TGT_2", Transform{moved(900)});
    ASSERT_TRUE(talk.reaction.command.has_value()) << time;
    talk.refused(StatusCode::unreachable);
  }
}

TEST(Brp2013, WhatFailedMayBeAskedForAgainUnderTheSameId) {
  Talk talk("brp2013");
  talk.ask("START_UP");
  talk.refused(StatusCode::not_ready);
  talk.ask("START_UP");
  ASSERT_TRUE(talk.reaction.command.has_value()) << "was refused";
  talk.proposed(4);
  talk.over(4, StatusCode::not_ready);
  talk.ask("START_UP");
  EXPECT_TRUE(talk.reaction.command.has_value()) << "its motion was aborted";
}

TEST_P(EachDialect, AStopThatComesAgainIsMeant) {
  for (const char* phase : {"STOP", "STOP", "EMERGENCY", "EMERGENCY"}) {
    talk.ask(phase);
    EXPECT_TRUE(std::holds_alternative<Stop>(talk.reaction.command.value())) << phase;
  }
}

TEST_P(EachDialect, StartUpIsOverWhenTheHomingThatSomebodyApprovedIs) {
  talk.ask("START_UP");
  EXPECT_EQ(talk.proposed(4), Shorts{});
  EXPECT_EQ(talk.over(3), Shorts{}) << "another motion";
  EXPECT_EQ(talk.over(4), Shorts{"START_UP 1"});
  EXPECT_EQ(talk.over(4), Shorts{}) << "once";
}

TEST_P(EachDialect, SilenceOfFiveSecondsIsBrokenOnce) {
  talk.ask("START_UP");
  talk.proposed(4);
  EXPECT_EQ(talk.due(1000ms), Shorts{});
  EXPECT_EQ(talk.due(5400ms), Shorts{});
  EXPECT_EQ(talk.due(5600ms), Shorts{"START_UP 6"});
  EXPECT_EQ(talk.due(20000ms), Shorts{});
  EXPECT_EQ(talk.over(4), Shorts{"START_UP 1"});
}

TEST_P(EachDialect, HardwareThatIsNotThereIsNotReady) {
  talk.ask("START_UP");
  EXPECT_EQ(talk.refused(StatusCode::not_ready), Shorts{"START_UP 13"});
}

TEST_P(EachDialect, ACalibrationIsEchoedExactlyThenStored) {
  talk.ask("START_UP");
  talk.ask("CALIBRATION");
  EXPECT_EQ(talk.send("CLB_9", Transform{moved(0.1f)}), Shorts{"ACK_9 TRANSFORM"});
  EXPECT_EQ(talk.reaction.replies[0].second, Body(Transform{moved(0.1f)}));
  EXPECT_EQ(std::get<SetRegistration>(talk.reaction.command.value()).scanner_from_robot, moved(0.1f));
  EXPECT_EQ(talk.refused(StatusCode::configuration), Shorts{"CALIBRATION 10"}) << "no rotation";
  talk.send("CLB_10", Transform{moved(3)});
  EXPECT_EQ(talk.stored(), Shorts{"CALIBRATION 1"});
}

TEST_P(EachDialect, ACalibrationInAnotherPhaseIsRefused) {
  talk.ask("START_UP");
  EXPECT_EQ(talk.send("CLB_9", Transform{}), (Shorts{"ACK_9 TRANSFORM", "CALIBRATION 13"}));
  EXPECT_FALSE(talk.reaction.command.has_value());
}

TEST_P(EachDialect, ATargetIsEchoedThenStoredAndToldAsItIsSet) {
  talk.target();
  EXPECT_EQ(talk.send("TGT_2", Transform{moved(7)}), Shorts{"ACK_2 TRANSFORM"});
  EXPECT_EQ(std::get<SetTargetPose>(talk.reaction.command.value()).scanner_from_target, moved(7));
  EXPECT_THAT(talk.stored(), testing::IsSupersetOf({"TARGET 1", "TARGET TRANSFORM"}));
  EXPECT_EQ(talk.reaction.replies[1].second, Body(Transform{moved(2)})) << "not as it was asked for";
}

TEST_P(EachDialect, ARefusedTargetLeavesNoneToMoveTo) {
  talk.target();
  talk.send("TGT_2", Transform{moved(7)});
  EXPECT_EQ(talk.refused(StatusCode::unreachable), Shorts{"TARGET 10"});
  EXPECT_EQ(talk.ask("MOVE_TO_TARGET"),
            (Shorts{"ACK_7 STRING", "CURRENT_STATUS 1 MOVE_TO_TARGET", "MOVE_TO_TARGET 13"}));
  EXPECT_FALSE(talk.reaction.command.has_value());
}

TEST_P(EachDialect, ATargetInAnotherPhaseIsRefused) {
  talk.target();
  talk.ask("PLANNING");
  EXPECT_EQ(talk.send("TGT_2", Transform{}), (Shorts{"ACK_2 TRANSFORM", "TARGET 13"}));
}

TEST_P(EachDialect, TheMoveStreamsThePositionAndEndsWithItsStatusAndOnePositionMore) {
  talk.target();
  EXPECT_EQ(talk.ask("MOVE_TO_TARGET"), (Shorts{"ACK_7 STRING", "CURRENT_STATUS 1 MOVE_TO_TARGET"}));
  EXPECT_EQ(talk.proposed(8), Shorts{});
  EXPECT_EQ(talk.due(100ms), Shorts{"CURRENT_POSITION TRANSFORM"});
  EXPECT_EQ(talk.due(60000ms), Shorts{"CURRENT_POSITION TRANSFORM"}) << "a stream is no silence";
  EXPECT_EQ(talk.over(8), (Shorts{"MOVE_TO_TARGET 1", "CURRENT_POSITION TRANSFORM"}));
  EXPECT_EQ(talk.due(60100ms), Shorts{});
}

TEST_P(EachDialect, WhileItMovesTheControllerHearsSomething) {
  talk.target();
  talk.ask("MOVE_TO_TARGET");
  talk.proposed(8);
  EXPECT_EQ(talk.due(50ms, true), Shorts{"CURRENT_POSITION TRANSFORM"});
  talk.state.measured_cp.reset();
  EXPECT_EQ(talk.due(100ms, true), Shorts{"CURRENT_STATUS 1 MOVE_TO_TARGET"});
}

TEST_P(EachDialect, AMoveThatIsAbortedSaysSo) {
  talk.target();
  talk.ask("MOVE_TO_TARGET");
  talk.proposed(8);
  EXPECT_EQ(talk.over(8, StatusCode::not_ready).at(0), "MOVE_TO_TARGET 13");
}

TEST_P(EachDialect, StopAndEmergencyActInEveryPhaseAndFromEverybody) {
  talk.target();
  talk.ask("MOVE_TO_TARGET");
  talk.proposed(8);
  for (const bool controls : {true, false}) {
    for (const bool cuts_power : {false, true}) {
      const std::string phase = cuts_power ? "EMERGENCY" : "STOP";
      EXPECT_EQ(talk.ask(phase, controls), (Shorts{"ACK_7 STRING", "CURRENT_STATUS 1 " + phase}));
      EXPECT_EQ(std::get<Stop>(talk.reaction.command.value()).cuts_power, cuts_power);
      EXPECT_EQ(talk.done(), Shorts{phase + " 1"});
    }
  }
  EXPECT_EQ(talk.over(8, StatusCode::not_ready), Shorts{}) << "it was stopped; that was said";
}

TEST_P(EachDialect, ManualCutsThePowerAndNoMoveFollowsIt) {
  talk.target();
  EXPECT_EQ(talk.ask("MANUAL"), (Shorts{"ACK_7 STRING", "CURRENT_STATUS 1 MANUAL"}));
  EXPECT_TRUE(std::holds_alternative<CutPower>(talk.reaction.command.value()));
  EXPECT_EQ(talk.done(), Shorts{"MANUAL 1"});
  EXPECT_EQ(talk.ask("MOVE_TO_TARGET").back(), "MOVE_TO_TARGET 13");
  EXPECT_FALSE(talk.reaction.command.has_value());
}

TEST_P(EachDialect, AnObserverEntersNoPhase) {
  EXPECT_EQ(talk.ask("START_UP", false),
            (Shorts{"ACK_7 STRING", "CURRENT_STATUS 5 UNDEFINED", "START_UP 5"}));
  EXPECT_FALSE(talk.reaction.command.has_value());
  EXPECT_THAT(talk.reaction.refused, HasSubstr("observer"));
}

TEST_P(EachDialect, AnUnknownPhaseIsAcknowledgedAndRefused) {
  for (const char* phase : {"DANCE", "", "start_up", "START_UP ", "UNDEFINED"}) {
    EXPECT_EQ(talk.ask(phase), (Shorts{"ACK_7 STRING", "ERROR 12"})) << phase;
  }
  EXPECT_EQ(talk.send("CMD_7", Transform{}), Shorts{"ERROR 10"});
}

TEST_P(EachDialect, QueriesTellPhasePositionTargetAndCalibration) {
  EXPECT_EQ(talk.send("CURRENT_STATUS", Query{"STATUS"}), Shorts{"CURRENT_STATUS 10 UNDEFINED"});
  EXPECT_EQ(talk.send("CALIBRATION", Query{"TRANS"}), Shorts{"CALIBRATION 4"});
  talk.target();
  EXPECT_EQ(talk.send("CALIBRATION", Query{"TRANS"}), Shorts{"CALIBRATION 4"}) << "it has expired";
  talk.state.scanner_from_robot = moved(1.0);
  EXPECT_EQ(talk.send("CURRENT_STATUS", Query{"STATUS"}), Shorts{"CURRENT_STATUS 1 TARGETING"});
  for (const char* name : {"CURRENT_POSITION", "TARGET_POSITION", "CALIBRATION"}) {
    EXPECT_EQ(talk.send(name, Query{"TRANS"}), Shorts{std::string(name) + " TRANSFORM"});
    EXPECT_EQ(talk.send(name, Query{"TRANSFOR"}), Shorts{std::string(name) + " TRANSFORM"});
  }
}

TEST_P(EachDialect, WhatIsUnwellIsTold) {
  Talk other(GetParam());
  const auto dialect = make_dialect(GetParam());
  EXPECT_TRUE(dialect->told(talk.state).empty());
  talk.state.health = {StatusCode::hardware_failure, 0, "LOCKED", "why"};
  EXPECT_EQ(shorts(dialect->told(talk.state)), Shorts{"ERROR 18"});
  EXPECT_EQ(shorts(dialect->take_broken("TGT_1", {StatusCode::checksum, 0, "FORMAT", "crc"}).replies),
            Shorts{"ERROR 9"});
}

TEST_P(EachDialect, AStatusIsNeverAnswered) { EXPECT_EQ(talk.send("", Status{}), Shorts{}); }

TEST_P(EachDialect, AnotherPhaseEndsTheMotionOfTheOneBefore) {
  talk.ask("START_UP");
  talk.proposed(4);
  talk.ask("MANUAL");
  EXPECT_EQ(talk.reaction.ends, 4u);
}

TEST_P(EachDialect, AMotionThatComesTooLateIsEnded) {
  talk.ask("START_UP");
  const Command late = talk.reaction.command.value();
  talk.ask("STOP");
  talk.reaction.command = late;
  EXPECT_EQ(talk.proposed(4), Shorts{"START_UP 13"});
  EXPECT_EQ(talk.reaction.ends, 4u);
}

TEST(Brp2013, AnyPhaseFollowsAnyOther) {
  for (std::size_t from = 1; from <= static_cast<std::size_t>(Phase::emergency); ++from) {
    for (std::size_t to = 1; to <= static_cast<std::size_t>(Phase::emergency); ++to) {
      Talk talk("brp2013");
      talk.ask(std::string(phase_name(static_cast<Phase>(from))));
      const std::string desired(phase_name(static_cast<Phase>(to)));
      EXPECT_EQ(talk.ask(desired).at(1), "CURRENT_STATUS 1 " + desired);
    }
  }
}

TEST(Brp2013, PlanningAndCalibrationSayNothingMore) {
  Talk talk("brp2013");
  for (const std::string phase : {"PLANNING", "CALIBRATION"}) {
    EXPECT_EQ(talk.ask(phase), (Shorts{"ACK_7 STRING", "CURRENT_STATUS 1 " + phase}));
    EXPECT_FALSE(talk.reaction.command.has_value());
  }
}

TEST(Brp2013, TargetingNeedsACalibration) {
  Talk talk("brp2013");
  EXPECT_EQ(talk.ask("TARGETING"), (Shorts{"ACK_7 STRING", "CURRENT_STATUS 1 TARGETING", "TARGETING 13"}));
  EXPECT_EQ(talk.send("TGT_1", Transform{}), (Shorts{"ACK_1 TRANSFORM", "TARGET 13"}));
  talk.target();
  EXPECT_EQ(talk.send("CMD_8", Text{"TARGETING"}).back(), "TARGETING 1");
}

TEST(Brp2013, OtherNamesAreRefused) {
  Talk talk("brp2013");
  EXPECT_EQ(talk.send("servo_cp", Transform{}), Shorts{"ERROR 12"});
  EXPECT_EQ(talk.send("RETRACT_NEEDLE", Text{""}), Shorts{"ERROR 12"});
}

/** The table of the dialect's transitions, as docs/openigtlink.md has it; STOP and EMERGENCY follow all. */
TEST(Wpi2024, PhasesFollowInTheirOrderAndARefusalIsAnswered) {
  const std::map<std::string, std::string> next{
      {"START_UP", "CALIBRATION MANUAL"},
      {"CALIBRATION", "PLANNING START_UP MANUAL"},
      {"PLANNING", "TARGETING CALIBRATION START_UP MANUAL"},
      {"TARGETING", "START_UP PLANNING CALIBRATION MOVE_TO_TARGET MANUAL"},
      {"MOVE_TO_TARGET", "START_UP PLANNING CALIBRATION TARGETING MANUAL"},
      {"MANUAL", "START_UP"}};
  const std::vector<std::string> way{"START_UP", "CALIBRATION", "PLANNING", "TARGETING", "MOVE_TO_TARGET"};
  for (const auto& [from, allowed] : next) {
    for (int to = 1; to <= static_cast<int>(Phase::emergency); ++to) {
      const std::string desired(phase_name(static_cast<Phase>(to)));
      Talk talk("wpi2024");
      for (const std::string& phase : way) {
        talk.ask(phase);
        if (phase == from || (from == "MANUAL" && phase == "START_UP")) {
          break;
        }
      }
      talk.ask(from == "MANUAL" ? "MANUAL" : "STATUS QUO");
      const bool may = (" " + allowed + " ").find(" " + desired + " ") != std::string::npos ||
                       desired == "STOP" || desired == "EMERGENCY";
      const Shorts answer = talk.send("CMD_8", Text{desired});
      EXPECT_EQ(answer.at(0), "ACK_8 STRING");
      EXPECT_EQ(answer.at(1), may ? "CURRENT_STATUS 1 " + desired : "CURRENT_STATUS 13 " + from)
          << from << " to " << desired;
      EXPECT_EQ(answer.size() > 2 && answer.back() == desired + " 13",
                !may || (may && desired == "MOVE_TO_TARGET"))
          << from << " to " << desired;
    }
  }
}

TEST(Wpi2024, FirstComesStartUp) {
  Talk talk("wpi2024");
  EXPECT_EQ(talk.ask("PLANNING"), (Shorts{"ACK_7 STRING", "CURRENT_STATUS 13 UNDEFINED", "PLANNING 13"}));
  EXPECT_EQ(talk.ask("START_UP").at(1), "CURRENT_STATUS 1 START_UP");
}

TEST(Wpi2024, AStopLeadsBackToWhereItCameFromOnly) {
  Talk talk("wpi2024");
  talk.target();
  talk.ask("STOP");
  EXPECT_EQ(talk.ask("MOVE_TO_TARGET").at(1), "CURRENT_STATUS 13 STOP");
  talk.ask("EMERGENCY");
  EXPECT_EQ(talk.ask("TARGETING").at(1), "CURRENT_STATUS 1 TARGETING");
}

TEST(Wpi2024, PlanningAndCalibrationSayThatTheyAreEntered) {
  Talk talk("wpi2024");
  talk.ask("START_UP");
  EXPECT_EQ(talk.ask("CALIBRATION").back(), "CALIBRATION 1");
  EXPECT_EQ(talk.ask("PLANNING").back(), "PLANNING 1");
}

TEST(Wpi2024, TargetingWithoutCalibrationIsDenied) {
  Talk talk("wpi2024");
  talk.ask("START_UP");
  talk.ask("CALIBRATION");
  talk.ask("PLANNING");
  EXPECT_EQ(talk.ask("TARGETING").back(), "TARGETING 5");
}

TEST(Wpi2024, WhatCanBeReachedIsToldAfterTargetAndCalibration) {
  Talk talk("wpi2024");
  talk.target();
  talk.send("TGT_2", Transform{moved(7)});
  EXPECT_EQ(talk.stored(), (Shorts{"TARGET 1", "TARGET TRANSFORM", "REACHABLE_TARGET TRANSFORM"}));
  talk.ask("CALIBRATION");
  talk.send("CLB_2", Transform{moved(7)});
  EXPECT_EQ(talk.stored(), (Shorts{"CALIBRATION 1", "REACHABLE_TARGET TRANSFORM"}));
}

TEST(Wpi2024, SubCodesOfATargetTellTheRefusalsApart) {
  Talk talk("wpi2024");
  talk.target();
  talk.send("TGT_2", Transform{moved(7)});
  talk.refused(StatusCode::configuration, 1);
  EXPECT_EQ(std::get<Status>(talk.reaction.replies.at(0).second).sub_code, 1);
  Talk older("brp2013");
  older.target();
  older.send("TGT_2", Transform{moved(7)});
  older.refused(StatusCode::configuration, 1);
  EXPECT_EQ(std::get<Status>(older.reaction.replies.at(0).second).sub_code, 0);
}

TEST(Wpi2024, ATargetDuringTheMoveReplacesItsMotion) {
  Talk talk("wpi2024");
  talk.target();
  talk.ask("MOVE_TO_TARGET");
  talk.proposed(8);
  talk.send("TGT_2", Transform{moved(7)});
  EXPECT_EQ(talk.reaction.ends, 8u);
  EXPECT_EQ(talk.over(8, StatusCode::not_ready), Shorts{});
  EXPECT_EQ(talk.stored().at(0), "TARGET 1");
  EXPECT_TRUE(std::holds_alternative<MoveToTarget>(talk.reaction.command.value()));
  EXPECT_EQ(talk.proposed(9), Shorts{});
  EXPECT_EQ(talk.over(9).at(0), "MOVE_TO_TARGET 1");
}

TEST(Wpi2024, TheMoveIsLeftOnceTheNeedleIsOut) {
  Talk talk("wpi2024");
  talk.target();
  talk.ask("MOVE_TO_TARGET");
  talk.proposed(8);
  talk.state.is_probe_out = false;
  EXPECT_EQ(talk.ask("TARGETING").at(1), "CURRENT_STATUS 13 MOVE_TO_TARGET");
  EXPECT_EQ(talk.send("RETRACT_NEEDLE", Text{""}), Shorts{"ACK_RETRACT_NEEDLE 1"});
  EXPECT_EQ(talk.reaction.ends, 8u);
  talk.proposed(9);
  talk.state.is_probe_out = true;
  EXPECT_EQ(talk.ask("TARGETING").at(1), "CURRENT_STATUS 13 MOVE_TO_TARGET") << "it still retracts";
  EXPECT_EQ(talk.over(9), Shorts{"RETRACT_NEEDLE 1"});
  EXPECT_EQ(talk.ask("TARGETING").at(1), "CURRENT_STATUS 1 TARGETING");
}

TEST(Wpi2024, TheNeedleHasRequestsOfItsOwn) {
  Talk talk("wpi2024");
  talk.ask("START_UP");
  EXPECT_EQ(talk.send("NEEDLE_LENGTH", Text{"150"}), Shorts{"ACK_NEEDLE_LENGTH STRING"});
  for (const char* wrong : {"", "long", "-1", "0", "1001", "nan", "150 mm"}) {
    EXPECT_EQ(talk.send("NEEDLE_LENGTH", Text{wrong}), Shorts{"ACK_NEEDLE_LENGTH 10"}) << wrong;
  }
  EXPECT_EQ(talk.send("RETRACT_NEEDLE", Text{""}), Shorts{"ACK_RETRACT_NEEDLE 13"});
  EXPECT_EQ(talk.send("NPOS_1", Transform{}), (Shorts{"ACK_1 TRANSFORM", "MOVE_TO_TARGET 13"}));
  EXPECT_EQ(talk.send("ALPHA", Text{"1"}), Shorts{"ACK_ALPHA 12"});
  EXPECT_EQ(talk.send("SING", Text{"1"}), Shorts{"ACK_SING 0"});
}

TEST(Wpi2024, TheNeedlesTipIsNotedDuringTheMove) {
  Talk talk("wpi2024");
  talk.target();
  EXPECT_EQ(talk.send("NEEDLE_LENGTH", Text{"150"}), Shorts{"ACK_NEEDLE_LENGTH 13"});
  talk.ask("MOVE_TO_TARGET");
  talk.proposed(8);
  EXPECT_EQ(talk.send("NPOS_1", Transform{moved(3)}), Shorts{"ACK_1 TRANSFORM"});
  EXPECT_EQ(std::get<ReportPose>(talk.reaction.command.value()).scanner_from_probe, moved(3));
  EXPECT_EQ(talk.done(), Shorts{"MOVE_TO_TARGET 1"});
}

TEST(Wpi2024, PositionIsAskedForByText) {
  Talk talk("wpi2024");
  talk.target();
  const Shorts names{"CURRENT_POSITION TRANSFORM", "IS_IN_TARGETING_POS STRING", "HAS_REACHED_TARGET STRING"};
  EXPECT_EQ(talk.send("CURRENT_POSITION", Text{""}), names);
  EXPECT_EQ(std::get<Text>(talk.reaction.replies[1].second).text, "1");
  EXPECT_EQ(std::get<Text>(talk.reaction.replies[2].second).text, "0") << "1 mm from it";
  talk.state.measured_cp = moved(1.9);
  talk.send("CURRENT_POSITION", Text{""});
  EXPECT_EQ(std::get<Text>(talk.reaction.replies[2].second).text, "1");
}

/** Any of the dialects, as a connection that controls nothing has it. */
class StopByName : public testing::TestWithParam<const char*> {
 protected:
  std::unique_ptr<Dialect> dialect_ = make_dialect(GetParam());
  RobotState state_;
};

INSTANTIATE_TEST_SUITE_P(Dialects, StopByName, testing::Values("thesis", "brp2013", "wpi2024"));

TEST_P(StopByName, OfAMessageOfAnyTypeStops) {
  const std::vector<Body> bodies{Transform{},     Text{"go"},      Status{},        Points{},
                                 Position{},      TrackingData{},  StartTracking{}, StopTracking{},
                                 TrackingReply{}, Array{},         Sensor{},        Capability{},
                                 Query{"STATUS"}, Query{"STRING"}, Query{"TDATA"}};
  for (const char* name : {"STOP", "stop", "EMERGENCY", "Emergency"}) {
    for (const Body& body : bodies) {
      const Reaction reaction = dialect_->take({name, body, 0, 1, {}}, state_, false);
      ASSERT_TRUE(reaction.command.has_value()) << name << " as " << type_of(body);
      EXPECT_TRUE(std::holds_alternative<Stop>(*reaction.command)) << name << " as " << type_of(body);
      EXPECT_FALSE(needs_control(*reaction.command)) << "anybody may stop the robot";
    }
  }
}

TEST_P(StopByName, OfAMessageThatCannotBeReadStopsAndTheFaultIsTold) {
  const Status fault{StatusCode::unknown_instruction, 0, "FORMAT", "why"};
  const Reaction reaction = dialect_->take_broken("STOP", fault);
  ASSERT_TRUE(reaction.command.has_value());
  EXPECT_TRUE(std::holds_alternative<Stop>(*reaction.command));
  ASSERT_FALSE(reaction.replies.empty());
  EXPECT_EQ(std::get<Status>(reaction.replies[0].second).code, StatusCode::unknown_instruction);
  EXPECT_FALSE(dialect_->take_broken("TARGET_POINT", fault).command.has_value());
}

TEST_P(StopByName, InAStatusIsNotConfirmedSoThatTwoRobotsDoNotStopEachOtherForEver) {
  const Outcome stopped{{StatusCode::ok, 0, "OK", ""}};
  const Reaction status = dialect_->take({"STOP", Status{}, 0, 1, {}}, state_, false);
  EXPECT_EQ(shorts(dialect_->finish("STOP", status.command.value(), stopped).replies), Shorts{});
  const Reaction text = dialect_->take({"STOP", Text{}, 0, 1, {}}, state_, false);
  EXPECT_EQ(shorts(dialect_->finish("STOP", text.command.value(), stopped).replies), Shorts{"STOP 1"});
}

TEST(Dialects, ThereAreThree) {
  for (const char* name : {"thesis", "brp2013", "wpi2024"}) {
    EXPECT_NE(make_dialect(name), nullptr) << name;
  }
  EXPECT_EQ(make_dialect("brp2014"), nullptr);
}

}  // namespace
}  // namespace interlock::igtl
