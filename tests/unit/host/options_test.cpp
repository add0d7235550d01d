#include "options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

using ::testing::HasSubstr;

struct Parsed {
  ilk_options_result_t result;
  ilk_options_t options;
  std::string error;
  std::vector<std::string> arguments;  // the options point into them
};

Parsed parse(std::vector<std::string> arguments) {
  Parsed parsed{};
  parsed.arguments = std::move(arguments);
  parsed.arguments.insert(parsed.arguments.begin(), "interlock-kernel");
  std::vector<char*> argv;
  argv.reserve(parsed.arguments.size() + 1);
  for (std::string& argument : parsed.arguments) {
    argv.push_back(argument.data());
  }
  argv.push_back(nullptr);
  ilk_error_t error{};
  parsed.result = ilk_options_parse(static_cast<int>(argv.size()) - 1, argv.data(), &parsed.options, &error);
  parsed.error = error.text;
  return parsed;
}

std::vector<std::string> complete(std::vector<std::string> more = {}) {
  std::vector<std::string> all{"--config", "r.ilkc", "--bus", "sim:/run/bus", "--link", "/run/link"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

TEST(Options, DefaultsAreTheWallClockAnyCoreAndPriority80) {
  const Parsed parsed = parse(complete());
  ASSERT_EQ(parsed.result, ILK_OPTIONS_RUN) << parsed.error;
  EXPECT_STREQ(parsed.options.config_path, "r.ilkc");
  EXPECT_STREQ(parsed.options.bus_path, "/run/bus");
  EXPECT_STREQ(parsed.options.link_path, "/run/link");
  EXPECT_EQ(parsed.options.clock, ILK_CLOCK_REAL);
  EXPECT_EQ(parsed.options.core, -1);
  EXPECT_EQ(parsed.options.priority, 80);
  EXPECT_EQ(parsed.options.black_box_path, nullptr);
}

TEST(Options, TheBusIsTheSimulatorOrWiredCards) {
  EXPECT_EQ(parse(complete()).options.bus, ILK_BUS_SIM);
  const Parsed wired = parse(complete({"--bus", "spi:/etc/interlock/wiring"}));
  ASSERT_EQ(wired.result, ILK_OPTIONS_RUN) << wired.error;
  EXPECT_EQ(wired.options.bus, ILK_BUS_SPI);
  EXPECT_STREQ(wired.options.bus_path, "/etc/interlock/wiring");
}

TEST(Options, BlackBoxHoldsAMinuteUnlessToldOtherwise) {
  const Parsed parsed = parse(complete({"--black-box", "/run/x/box"}));
  ASSERT_EQ(parsed.result, ILK_OPTIONS_RUN) << parsed.error;
  EXPECT_STREQ(parsed.options.black_box_path, "/run/x/box");
  EXPECT_EQ(parsed.options.black_box_seconds, 60);
  EXPECT_EQ(parse(complete({"--black-box-seconds", "5"})).options.black_box_seconds, 5);
  const Parsed none = parse(complete({"--black-box-seconds", "0"}));
  EXPECT_EQ(none.result, ILK_OPTIONS_BAD);
  EXPECT_THAT(none.error, HasSubstr("--black-box-seconds is '0'; expected a number from 1 to 3600"));
}

TEST(Options, EveryOptionIsTaken) {
  const Parsed parsed =
      parse(complete({"--clock=paced", "--speed", "2.5", "--core", "1", "--priority", "42"}));
  ASSERT_EQ(parsed.result, ILK_OPTIONS_RUN) << parsed.error;
  EXPECT_EQ(parsed.options.clock, ILK_CLOCK_SIM);
  EXPECT_TRUE(parsed.options.paced);
  EXPECT_EQ(parsed.options.speed, 2.5);
  EXPECT_EQ(parsed.options.core, 1);
  EXPECT_EQ(parsed.options.priority, 42);
}

TEST(Options, SimulatedTimeIsPacedOrAsFastAsPossible) {
  EXPECT_EQ(parse(complete({"--clock=paced"})).options.speed, 1.0);
  const Parsed fast = parse(complete({"--clock=sim"}));
  ASSERT_EQ(fast.result, ILK_OPTIONS_RUN) << fast.error;
  EXPECT_EQ(fast.options.clock, ILK_CLOCK_SIM);
  EXPECT_FALSE(fast.options.paced);
}

TEST(Options, HelpIsNoError) { EXPECT_EQ(parse({"--help"}).result, ILK_OPTIONS_HELP); }

TEST(Options, MissingOnesAreNamed) {
  EXPECT_THAT(parse({}).error, HasSubstr("--config FILE.ilkc is missing"));
  EXPECT_THAT(parse({"--config", "r"}).error, HasSubstr("--bus sim:SOCKET or spi:FILE is missing"));
  EXPECT_THAT(parse({"--config", "r", "--bus", "sim:b"}).error, HasSubstr("--link SOCKET is missing"));
}

TEST(Options, BadValuesAreNamedWithWhatWasExpected) {
  struct Row {
    std::string option, value, expected;
  };
  const std::vector<Row> bad{
      {"--clock", "wall", "real, paced or sim"},
      {"--bus", "spi:", "sim:SOCKET or spi:FILE"},
      {"--bus", "sim:", "sim:SOCKET or spi:FILE"},
      {"--speed", "0", "a number from 0.001 to 1000"},
      {"--speed", "-1", "a number from 0.001 to 1000"},
      {"--speed", "nan", "a number from 0.001 to 1000"},
      {"--speed", "1x", "a number from 0.001 to 1000"},
      {"--speed", "1001", "a number from 0.001 to 1000"},
      {"--core", "-1", "the number of a core"},
      {"--core", "99999999999999999999", "the number of a core"},
      {"--priority", "0", "a number from 1 to 99"},
      {"--priority", "100", "a number from 1 to 99"},
      {"--link", "", "the path of a socket"},
      {"--config", "", "a file"},
  };
  for (const auto& [option, value, expected] : bad) {
    const Parsed parsed = parse(complete({option, value}));
    EXPECT_EQ(parsed.result, ILK_OPTIONS_BAD) << option << " " << value;
    const std::string wanted =
        (::testing::Message() << option << " is '" << value << "'; expected " << expected).GetString();
    EXPECT_EQ(parsed.error, wanted);
  }
}

TEST(Options, UnknownOptionsStrayWordsAndMissingValuesAreNamed) {
  EXPECT_THAT(parse({"--bogus"}).error, HasSubstr("--bogus is not an option"));
  EXPECT_THAT(parse({"-x"}).error, HasSubstr("-x is not an option"));
  EXPECT_THAT(parse({"-xyz"}).error, HasSubstr("-x is not an option"));
  EXPECT_THAT(parse(complete({"--core"})).error, HasSubstr("--core needs a value"));
  EXPECT_THAT(parse(complete({"stray"})).error, HasSubstr("'stray' is not expected here"));
}

TEST(Options, SpeedWithTheWallClockIsRefused) {
  for (const char* clock : {"real", "sim"}) {
    EXPECT_THAT(parse(complete({"--clock", clock, "--speed", "2"})).error,
                HasSubstr("--speed applies to the paced clock only"));
  }
}

}  // namespace
