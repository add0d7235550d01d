#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "cli/commands.hpp"

namespace interlock::cli {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

json locked_status() {
  return {
      {"version", "0.1.0"},
      {"commit", "abc"},
      {"robot", "neuro"},
      {"simulated", true},
      {"degraded", true},
      {"clock", "real"},
      {"host_late", nullptr},
      {"connected", true},
      {"mode", "LOCKED"},
      {"cause", "BOOT"},
      {"tick", 1234},
      {"estop", false},
      {"pedal", "RELEASED"},
      {"pedal_armed", false},
      {"power", "off"},
      {"app_alive", true},
      {"config_crc", "869e140a"},
      {"age_ms", 0.26},
      {"cards",
       {{{"slot", 3}, {"card", "NON_PWM"}, {"detected", false}, {"heartbeat", 1}, {"checksum_failures", 7}}}},
      {"timing", json::object()}};
}

TEST(StatusTable, says_mode_and_cause_with_their_meaning_and_the_next_step) {
  const std::string table = status_table(locked_status().dump()).value();
  EXPECT_THAT(table, HasSubstr("Mode        LOCKED: Motion is latched off"));
  EXPECT_THAT(table, HasSubstr("Cause       BOOT: The kernel has just started."));
  EXPECT_THAT(table, HasSubstr("Next: "));
}

TEST(StatusTable, says_what_hardware_clock_and_configuration_it_is) {
  const std::string table = status_table(locked_status().dump()).value();
  EXPECT_THAT(table, HasSubstr("simulated hardware, real clock, degraded"));
  EXPECT_THAT(table, HasSubstr("neuro, configuration 869e140a"));
  EXPECT_THAT(table, HasSubstr("0.3 ms at tick 1234"));
}

TEST(StatusTable, says_how_late_the_host_is_when_simulated_time_waits_for_it) {
  json status = locked_status();
  EXPECT_THAT(status_table(status.dump()).value(), Not(HasSubstr("Host ")));
  status["clock"] = "paced";
  status["host_late"] = {{"now_ms", 34.25}, {"worst_ms", 5012.6}, {"total_ms", 7001}};
  EXPECT_THAT(status_table(status.dump()).value(),
              HasSubstr("Host        late by 34.2 ms now, by 5012.6 ms at worst, by 7001 ms in all"));
}

TEST(StatusTable, names_a_card_that_is_not_there) {
  EXPECT_THAT(status_table(locked_status().dump()).value(),
              HasSubstr("slot 3 NON_PWM, NOT DETECTED, 7 checksum failures"));
}

TEST(StatusTable, shows_no_old_state_without_a_kernel) {
  json status = locked_status();
  status["connected"] = false;
  const std::string table = status_table(status.dump()).value();
  EXPECT_THAT(table, HasSubstr("NOT CONNECTED"));
  EXPECT_THAT(table, Not(HasSubstr("Pedal")));
}

TEST(StatusTable, refuses_what_is_no_status) {
  json wrong_type = locked_status();
  wrong_type["tick"] = "many";
  for (const std::string& body :
       {std::string("<html>"), std::string("{}"), std::string(""), wrong_type.dump()}) {
    const auto table = status_table(body);
    ASSERT_FALSE(table) << body;
    EXPECT_EQ(table.error().code, ExitCode::no_answer);
    EXPECT_THAT(table.error().text, HasSubstr("expected the Status"));
  }
}

}  // namespace
}  // namespace interlock::cli
