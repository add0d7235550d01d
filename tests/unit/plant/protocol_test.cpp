#include "plant/sim/protocol.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench.hpp"

namespace interlock::plant::test {
namespace {

using nlohmann::json;
using sim::parse_request;
using ::testing::HasSubstr;

std::string fault_of(const std::string& line) {
  const auto request = parse_request(line, 0);
  return request ? "accepted" : request.error().reason;
}

template <typename Wanted>
Wanted command_of(const std::string& line) {
  const auto request = parse_request(line, 0);
  EXPECT_TRUE(request) << request.error().reason;
  return std::get<Wanted>(std::get<command::Command>(request->wish));
}

TEST(PlantProtocol, ReadsEveryCommandOfTheReadme) {
  EXPECT_TRUE(command_of<command::PressPedal>(R"({"command":"pedal","pressed":true})").pressed);
  const auto contact =
      command_of<command::StickPedalContact>(R"({"command":"pedal_contact","contact":"nc","state":"open"})");
  EXPECT_FALSE(contact.normally_open);
  EXPECT_EQ(contact.closed, false);
  EXPECT_TRUE(command_of<command::PullEstop>(R"({"command":"estop","pulled":true})").pulled);
  EXPECT_EQ(command_of<command::JamAxis>(R"({"command":"jam","slot":4,"jammed":true})").slot, 4u);
  EXPECT_EQ(command_of<command::PushAxis>(R"({"command":"push","slot":4,"counts":-9})").counts, -9);
  EXPECT_EQ(command_of<command::JumpCounter>(R"({"command":"jump","slot":4,"counts":9})").counts, 9);
  EXPECT_EQ(command_of<command::RunAway>(R"({"command":"runaway","slot":4,"counts_per_tick":-1.5})")
                .counts_per_tick,
            -1.5);
  EXPECT_TRUE(
      command_of<command::ReverseMotor>(R"({"command":"reverse","slot":4,"reversed":true})").reversed);
  EXPECT_TRUE(command_of<command::StickEncoder>(R"({"command":"encoder","slot":4,"state":"stuck"})").stuck);
  EXPECT_EQ(command_of<command::StickSwitch>(R"({"command":"switch","slot":4,"state":"normal"})").triggered,
            std::nullopt);
  const auto frame =
      command_of<command::SpoilFrames>(R"({"command":"frame","slot":"all","fault":"deaf","count":3})");
  EXPECT_EQ(frame.slot, std::nullopt);
  EXPECT_EQ(frame.fault, FrameFault::kDeaf);
  EXPECT_EQ(frame.count, 3u);
  EXPECT_EQ(command_of<command::SpoilFrames>(R"({"command":"frame","slot":2,"fault":"drop","count":1})").slot,
            2u);
  EXPECT_EQ(command_of<command::ResetCard>(R"({"command":"card_reset","slot":4})").slot, 4u);
  EXPECT_FALSE(command_of<command::PowerCard>(R"({"command":"card_power","slot":4,"on":false})").on);
  const auto parameters = command_of<command::ChangeParameters>(
      R"({"command":"parameters","slot":4,"lag_ms":12.5,"noise_counts":3})");
  EXPECT_EQ(parameters.slot, 4u);
  for (std::size_t knob = 0; knob < kAxisKnobCount; ++knob) {
    const std::string_view name = kAxisKnobs[knob].name;
    EXPECT_EQ(parameters.value[knob], name == "lag_ms"         ? std::optional(12.5)
                                      : name == "noise_counts" ? std::optional(3.0)
                                                               : std::nullopt)
        << name;
  }
  EXPECT_EQ(command_of<command::RestoreParameters>(R"({"command":"parameters_restore","slot":4})").slot, 4u);
  const auto force = command_of<command::PressSensor>(R"({"command":"force","slot":3,"adc":2,"counts":-40})");
  EXPECT_EQ(force.input, 1u);
  EXPECT_EQ(force.counts, -40);
  EXPECT_EQ(command_of<command::FailTransactions>(R"({"command":"transaction","count":2})").count, 2u);
  command_of<command::Clear>(R"({"command":"clear"})");
  const auto range = parse_request(R"({"command":"record","from":5,"to":9})", 0);
  EXPECT_EQ(std::get<sim::RecordQuery>(range->wish).to, 9u);
  const auto event = parse_request(R"({"command":"record_event","kind":"kernel_silent"})", 0);
  EXPECT_EQ(std::get<sim::EventQuery>(event->wish).kind, Event::kKernelSilent);
}

TEST(PlantProtocol, EchoesIdAndKeepsAt) {
  const auto request = parse_request(R"({"command":"status","id":{"a":[1]},"at":77})", 0);
  ASSERT_TRUE(request);
  EXPECT_EQ(request->id, json::parse(R"({"a":[1]})"));
  EXPECT_EQ(request->at, 77u);
  EXPECT_EQ(json::parse(sim::accepted(request->id, 77)),
            json::parse(R"({"id":{"a":[1]},"ok":true,"tick":77})"));
}

TEST(PlantProtocol, after_counts_from_the_tick_at_which_the_line_came) {
  const auto request = parse_request(R"({"command":"estop","pulled":true,"after":30})", 1200);
  ASSERT_TRUE(request);
  EXPECT_EQ(request->at, 1230U);
  EXPECT_FALSE(parse_request(R"({"command":"estop","pulled":true,"at":1300,"after":30})", 1200));
}

TEST(PlantProtocol, FaultyLineIsRefusedWithFieldAndExpectation) {
  EXPECT_THAT(fault_of(""), HasSubstr("expected one JSON object a line"));
  EXPECT_THAT(fault_of("[1,2]"), HasSubstr("expected one JSON object a line"));
  EXPECT_THAT(fault_of(R"({"command":"pedal","pressed":)"), HasSubstr("expected one JSON object a line"));
  EXPECT_THAT(fault_of("{\"command\":\"\xff\"}"), HasSubstr("expected one JSON object a line"));
  EXPECT_THAT(fault_of(std::string(4000, '[')), HasSubstr("expected one JSON object a line"));
  EXPECT_THAT(fault_of(R"({"pressed":true})"), HasSubstr("'command': expected one of pedal, pedal_contact"));
  EXPECT_THAT(fault_of(R"({"command":7})"), HasSubstr("'command': expected one of"));
  EXPECT_EQ(fault_of(R"({"command":"pedal"})"), "pedal: 'pressed': expected true or false");
  EXPECT_EQ(fault_of(R"({"command":"pedal","pressed":1})"), "pedal: 'pressed': expected true or false");
  EXPECT_EQ(fault_of(R"({"command":"pedal","pressed":true,"colour":1})"),
            "pedal: 'colour': unknown field; this command takes id, command, pressed");
  EXPECT_EQ(fault_of(R"({"command":"jam","slot":10,"jammed":true})"),
            "jam: 'slot': expected a whole number from 0 to 9");
  EXPECT_EQ(fault_of(R"({"command":"jam","slot":-1,"jammed":true})"),
            "jam: 'slot': expected a whole number from 0 to 9");
  EXPECT_EQ(fault_of(R"({"command":"jam","slot":18446744073709551615,"jammed":true})"),
            "jam: 'slot': expected a whole number from 0 to 9");
  EXPECT_EQ(fault_of(R"({"command":"jam","slot":"all","jammed":true})"),
            "jam: 'slot': expected a whole number from 0 to 9");
  EXPECT_EQ(fault_of(R"({"command":"runaway","slot":0,"counts_per_tick":1e300})"),
            "runaway: 'counts_per_tick': expected a number from -1000.0 to 1000.0");
  EXPECT_THAT(fault_of(R"({"command":"parameters","slot":0})"),
              HasSubstr("expected this or another parameter"));
  EXPECT_EQ(fault_of(R"({"command":"parameters","slot":0,"lag_ms":0})"),
            "parameters: 'lag_ms': expected a number from 0.1 to 1000.0");
  EXPECT_EQ(fault_of(R"({"command":"parameters","slot":0,"lag_ms":5,"noise_counts":1.5})"),
            "parameters: 'noise_counts': expected a whole number from 0.0 to 100.0");
  EXPECT_EQ(fault_of(R"({"command":"parameters","slot":0,"noise_chance":"high"})"),
            "parameters: 'noise_chance': expected a number from 0.0 to 1.0");
  EXPECT_THAT(fault_of(R"({"command":"parameters","slot":0,"lag_ms":5,"start_counts":1})"),
              HasSubstr("'start_counts': unknown field"));
  EXPECT_EQ(fault_of(R"({"command":"frame","slot":0,"fault":"drop","count":0})"),
            "frame: 'count': expected a whole number from 1 to 1000000");
  EXPECT_EQ(fault_of(R"({"command":"frame","slot":0,"fault":"melt","count":1})"),
            "frame: 'fault': expected one of corrupt, drop, delay, repeat, deaf");
  EXPECT_EQ(fault_of(R"({"command":"record","from":9,"to":5})"),
            "record: 'to': expected a tick not before 'from'");
  EXPECT_THAT(fault_of(R"({"command":"status","at":-1})"), HasSubstr("'at': expected a whole number from 0"));
  EXPECT_THAT(fault_of(R"({"command":"status","at":1.5})"),
              HasSubstr("'at': expected a whole number from 0"));
}

TEST(PlantProtocol, RefusalEchoesTheId) {
  const auto request = parse_request(R"({"command":"pedal","id":5})", 0);
  ASSERT_FALSE(request);
  EXPECT_EQ(json::parse(sim::refused(request.error())),
            json::parse(R"({"id":5,"ok":false,"error":"pedal: 'pressed': expected true or false"})"));
}

TEST(PlantProtocol, StatusShowsWhatABenchShows) {
  Bench bench(exact_parameters());
  bench.drive(kNonPwm, Sense::kIncreasing, kMaxDrive);
  bench.exchange.lamp[ILK_LAMP_PEDAL] = ILK_COLOUR_GREEN;
  bench.schedule(command::PressPedal{true});
  bench.schedule(command::StickSwitch{kPwm, true});
  bench.run(100);
  const json status = sim::status_of(bench.plant, ILK_CLOCK_SIM);
  EXPECT_EQ(status["kernel"], json::parse(R"({"attached":true,"clock":"sim","tick":100})"));
  EXPECT_EQ(status["pedal"],
            json::parse(R"({"pressed":true,"no_closed":true,"nc_closed":false,"no":"free","nc":"free"})"));
  EXPECT_EQ(status["estop"], json::parse(R"({"pulled":false,"loop_closed":true})"));
  EXPECT_EQ(status["lamps"]["pedal"], "GREEN");
  EXPECT_EQ(status["lamps"]["stall"], "OFF");
  ASSERT_EQ(status["axes"].size(), 5u);
  const json& axis = status["axes"][1];
  EXPECT_EQ(axis["slot"], kNonPwm);
  EXPECT_GT(axis["position_counts"], 80);
  EXPECT_NEAR(axis["speed_counts_per_s"].get<double>(), 1000, 1);
  EXPECT_EQ(axis["drive"], 0x40000000u + kMaxDrive);
  EXPECT_EQ(status["axes"][0]["switch"], "triggered");
  EXPECT_EQ(axis["parameters_changed"], false);
  EXPECT_EQ(axis["parameters"]["lag_ms"], 5.0);
  EXPECT_EQ(axis["parameters"]["coast_counts"], 5.0);
  EXPECT_EQ(axis["parameters"].size(), kAxisKnobCount + 1);
  ASSERT_EQ(status["cards"].size(), 6u);
  EXPECT_EQ(status["cards"][5]["type"], "SENSOR");
  EXPECT_EQ(status["cards"][1]["amplifier"], true);
}

TEST(PlantProtocol, StatusTellsWhichAxisHasOtherParametersThanItsFile) {
  Bench bench(exact_parameters());
  const auto wish = command_of<command::ChangeParameters>(R"({"command":"parameters","slot":2,"lag_ms":8})");
  bench.schedule(wish);
  bench.run(1);
  const json axes = sim::status_of(bench.plant, ILK_CLOCK_SIM)["axes"];
  EXPECT_EQ(axes[1]["slot"], kNonPwm);
  EXPECT_EQ(axes[1]["parameters_changed"], true);
  EXPECT_EQ(axes[1]["parameters"]["lag_ms"], 8.0);
  EXPECT_EQ(axes[1]["parameters"]["coast_counts"], 8.0);
  EXPECT_EQ(axes[0]["parameters_changed"], false);
  EXPECT_TRUE(bench.plant.refusal(command::ChangeParameters{kSensor, {}}));
}

TEST(PlantProtocol, StatusBeforeTheFirstExchangeIsWhole) {
  Bench bench(exact_parameters());
  const json status = sim::status_of(bench.plant, std::nullopt);
  EXPECT_EQ(status["kernel"], json::parse(R"({"attached":false,"clock":null,"tick":0})"));
  EXPECT_EQ(status["pedal"],
            json::parse(R"({"pressed":false,"no_closed":false,"nc_closed":true,"no":"free","nc":"free"})"));
}

TEST(PlantProtocol, RecordAnswerIsTheSameInPiecesOfAnySize) {
  Bench bench(exact_parameters());
  bench.drive(kPwm, Sense::kDecreasing, 77);
  bench.run(50);
  const auto answer_in_pieces_of = [&bench](std::uint64_t size) {
    sim::RecordAnswer answer(5, bench.plant, {.from = 10, .to = 29});
    std::string text;
    while (!answer.append(bench.plant.record(), size, text)) {
    }
    return text;
  };
  const std::string whole = answer_in_pieces_of(1000);
  EXPECT_EQ(answer_in_pieces_of(1), whole);
  EXPECT_EQ(answer_in_pieces_of(7), whole);
  const json answer = json::parse(whole);
  EXPECT_EQ(answer["id"], 5);
  EXPECT_EQ(answer["tick"], 50);
  EXPECT_EQ(answer["oldest"], 0);
  ASSERT_EQ(answer["entries"].size(), 20u);
  EXPECT_EQ(answer["entries"][0],
            json::parse(R"({"tick":10,"kernel_tick":11,"pedal_no":false,"pedal_nc":true,"estop_loop":true,
                            "drive":[77,0,0,0,0,0,0,0,0,0],"amplifier":[1,0,0,0,0,0,0,0,0,0],
                            "counts":[0,0,0,0,0,0,0,0,0,0]})"));
}

TEST(PlantProtocol, LongRecordIsAnsweredPageByPage) {
  Bench bench(exact_parameters());
  bench.run(45'000);
  std::uint64_t from = 0;
  std::uint64_t expected = 0;
  for (int page = 0; page < 3; ++page) {
    sim::RecordAnswer answer(nullptr, bench.plant, {.from = from, .to = 1'000'000});
    std::string text;
    answer.append(bench.plant.record(), 1'000'000, text);
    const json parsed = json::parse(text);
    for (const json& entry : parsed["entries"]) {
      ASSERT_EQ(entry["tick"], expected++);
    }
    EXPECT_EQ(parsed.contains("next"), page < 2);
    from = parsed.value("next", std::uint64_t{0});
  }
  EXPECT_EQ(expected, 45'000u);
}

TEST(PlantProtocol, EventThatNeverHappenedIsNull) {
  Bench bench(exact_parameters());
  EXPECT_EQ(sim::newest_of(bench.plant, Event::kEstopPulled), json::parse(R"({"event_tick":null})"));
}

}  // namespace
}  // namespace interlock::plant::test
