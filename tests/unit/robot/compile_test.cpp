#include "robot/compile.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <random>

#include "interlock/kernel.h"
#include "neuro.hpp"

namespace interlock {
namespace {

using testing::HasSubstr;

TEST(Compile, the_kernel_accepts_neuro) {
  const auto config = compile(test::neuro());
  ASSERT_TRUE(config) << config.error().message();
  EXPECT_EQ(ilk_config_validate(&*config).error, static_cast<std::uint32_t>(ILK_CONFIG_ERROR_NONE));
}

TEST(Compile, neuro_keeps_its_numbers) {
  const ilk_config_t config = compile(test::neuro()).value();
  EXPECT_EQ(config.common.period_us, 1000u);
  EXPECT_EQ(config.common.pedal_channels, 2u);
  EXPECT_EQ(config.common.app_timeout_ticks, 100u);
  EXPECT_EQ(config.common.lease_max_ticks, 100u);
  EXPECT_EQ(config.common.pedal_debounce_ticks, 10u);
  EXPECT_EQ(config.common.pedal_disagree_ticks, 50u);
  EXPECT_EQ(config.common.power_up_ticks, 20u);
  EXPECT_EQ(config.common.switch_debounce_ticks, 5u);
  EXPECT_EQ(config.common.bad_frame_limit, 3u);
  EXPECT_EQ(config.common.overrun_limit, 3u);

  const ilk_axis_config_t& yaw = config.axis[0];
  EXPECT_EQ(yaw.card, static_cast<std::uint32_t>(ILK_CARD_PWM));
  EXPECT_EQ(yaw.limit_side, static_cast<std::uint32_t>(ILK_LIMIT_UPPER));
  EXPECT_EQ(yaw.min_counts, -1222);
  EXPECT_EQ(yaw.max_counts, 8);
  EXPECT_EQ(yaw.max_drive, 0xefffu);
  EXPECT_EQ(yaw.unhomed_max_drive, 0xefffu / 10);
  EXPECT_EQ(yaw.dead_zone_drive, 922u);
  EXPECT_EQ(yaw.home_drive, yaw.unhomed_max_drive);
  EXPECT_EQ(yaw.home_slow_drive, 2227u);
  EXPECT_EQ(yaw.home_speed_counts_per_s, 60u);
  EXPECT_EQ(yaw.home_slow_speed_counts_per_s, 12u);
  EXPECT_EQ(yaw.home_travel_counts, 1493u);
  EXPECT_EQ(yaw.home_timeout_ticks, 34000u);
  EXPECT_EQ(yaw.home_clear_counts, 21u);
  EXPECT_EQ(yaw.home_tolerance_counts, 4u);
  EXPECT_EQ(yaw.switch_hysteresis_counts, 3u);
  EXPECT_EQ(yaw.full_speed_counts_per_s, 1000u);
  EXPECT_EQ(yaw.stall_ticks, 500u);
  EXPECT_EQ(yaw.stall_effort_ticks, 68u);
  EXPECT_EQ(yaw.rest_ticks, 50u);
}

TEST(Compile, slots_without_axis_are_empty) {
  const ilk_config_t config = compile(test::neuro()).value();
  const ilk_axis_config_t empty{};
  for (const std::uint32_t slot : {5u, 8u, 9u}) {
    EXPECT_EQ(std::memcmp(&config.axis[slot], &empty, sizeof empty), 0) << slot;
  }
}

TEST(Compile, axes_without_switch_have_no_homing) {
  const ilk_axis_config_t feet = compile(test::neuro()).value().axis[6];
  EXPECT_EQ(feet.home_drive, 0u);
  EXPECT_EQ(feet.home_slow_drive, 0u);
  EXPECT_EQ(feet.home_travel_counts, 0u);
  EXPECT_EQ(feet.home_timeout_ticks, 0u);
  EXPECT_EQ(feet.home_clear_counts, 0u);
  EXPECT_EQ(feet.home_tolerance_counts, 0u);
  EXPECT_EQ(feet.switch_hysteresis_counts, 0u);
  EXPECT_EQ(feet.home_speed_counts_per_s, 0u);
  EXPECT_EQ(feet.home_slow_speed_counts_per_s, 0u);
}

TEST(Compile, gives_the_same_bytes_on_every_run) {
  const ConfigBytes first = encode(compile(test::neuro()).value());
  for (int run = 0; run < 10; ++run) {
    ASSERT_EQ(encode(compile(test::neuro()).value()), first);
  }
}

TEST(Compile, the_order_of_axes_in_the_file_does_not_matter) {
  Robot robot = test::neuro();
  const ConfigBytes first = encode(compile(robot).value());
  std::mt19937 random(20180501);
  for (int run = 0; run < 10; ++run) {
    std::ranges::shuffle(robot.axes, random);
    ASSERT_EQ(encode(compile(robot).value()), first);
  }
}

TEST(Compile, what_people_read_does_not_change_the_configuration) {
  Robot renamed = test::neuro();
  const ilk_config_t config = compile(renamed).value();
  renamed.title = "Another";
  renamed.axes.front().title = "Another";
  renamed.axes.front().gains.velocity = 1.0;
  EXPECT_EQ(compile(renamed).value().crc, config.crc);
}

TEST(Compile, a_slot_that_does_not_exist_is_refused) {
  Robot robot = test::neuro();
  robot.axes.front().slot = ILK_SLOTS;
  const auto config = compile(robot);
  ASSERT_FALSE(config);
  EXPECT_EQ(config.error().key, "axis.yaw.slot");
}

/** One kernel rule broken in an otherwise sound file. */
struct RuleBroken {
  const char* rule;
  const char* from;
  const char* to;
  const char* at;
  const char* key;
};

void PrintTo(const RuleBroken& broken, std::ostream* stream) { *stream << broken.rule; }

class KernelRule : public testing::TestWithParam<RuleBroken> {};

TEST_P(KernelRule, is_named_with_its_text_at_its_line_and_key) {
  const std::string text = test::neuro_with(GetParam().from, GetParam().to);
  const auto robot = parse_robot(text, "broken.toml");
  ASSERT_TRUE(robot) << robot.error().message();
  const auto config = compile(*robot);
  ASSERT_FALSE(config);
  EXPECT_EQ(config.error().file, "broken.toml");
  EXPECT_EQ(config.error().line, test::line_of(text, GetParam().at)) << config.error().message();
  EXPECT_EQ(config.error().key, GetParam().key);
  EXPECT_THAT(config.error().expected, HasSubstr(GetParam().rule));
  EXPECT_FALSE(config.error().problem.empty());
}

INSTANTIATE_TEST_SUITE_P(
    Each, KernelRule,
    testing::Values(
        RuleBroken{"PERIOD", "period_us = 1000", "period_us = 100", "period_us", "period_us"},
        RuleBroken{"PEDAL_CHANNELS", "channels = 2", "channels = 3", "channels = 3", "pedal.channels"},
        RuleBroken{"PEDAL_DEBOUNCE", "debounce_ms = 10", "debounce_ms = 51", "debounce_ms",
                   "pedal.debounce_ms"},
        RuleBroken{"PEDAL_DISAGREE", "disagree_ms = 50", "disagree_ms = 0", "disagree_ms",
                   "pedal.disagree_ms"},
        RuleBroken{"APP_TIMEOUT", "app_timeout_ms = 100", "app_timeout_ms = 151", "app_timeout_ms",
                   "loop.app_timeout_ms"},
        RuleBroken{"LEASE", "lease_max_ms = 100", "lease_max_ms = 0", "lease_max_ms", "loop.lease_max_ms"},
        RuleBroken{"POWER_UP", "power_up_ms = 20", "power_up_ms = 5001", "power_up_ms", "loop.power_up_ms"},
        RuleBroken{"SWITCH_DEBOUNCE", "switch_debounce_ms = 5", "switch_debounce_ms = 1",
                   "switch_debounce_ms", "loop.switch_debounce_ms"},
        RuleBroken{"BAD_FRAMES", "bad_frame_limit = 3", "bad_frame_limit = 6", "bad_frame_limit",
                   "loop.bad_frame_limit"},
        RuleBroken{"OVERRUNS", "overrun_limit = 3", "overrun_limit = 0", "overrun_limit",
                   "loop.overrun_limit"},
        RuleBroken{"SOFT_LIMITS", "max_counts = 1650", "max_counts = 0", "max_counts = 0",
                   "axis.insertion.soft_limits"},
        RuleBroken{"HOME_OFFSET", "home_offset_counts = 516", "home_offset_counts = 517",
                   "home_offset_counts = 517", "axis.pitch.home_offset_counts"},
        RuleBroken{"COAST", "coast_counts = 12", "coast_counts = 700", "coast_counts = 700",
                   "axis.yaw.mechanics.coast_counts"},
        RuleBroken{"DEADBAND", "deadband_counts = 1", "deadband_counts = 0", "deadband_counts = 0",
                   "axis.yaw.deadband_counts"},
        RuleBroken{"MAX_DRIVE", "max = 0x1FFFF", "max = 0x40000000", "0x40000000", "axis.pitch.drive.max"},
        RuleBroken{"UNHOMED_DRIVE", "unhomed_max = 6143", "unhomed_max = 6974", "6974",
                   "axis.yaw.drive.unhomed_max"},
        RuleBroken{"UNHOMED_TRAVEL", "unhomed_travel_counts = 98", "unhomed_travel_counts = 124", "= 124",
                   "axis.yaw.unhomed_travel_counts"},
        RuleBroken{"HOME_DRIVE", "drive = 6143", "drive = 6144", "drive = 6144", "axis.yaw.homing.drive"},
        RuleBroken{"HOME_TRAVEL", "travel_counts = 1493", "travel_counts = 1241", "= 1241",
                   "axis.yaw.homing.travel_counts"},
        RuleBroken{"HOME_SLOW", "slow_drive = 2227", "slow_drive = 922", "slow_drive = 922",
                   "axis.yaw.homing.slow_drive"},
        RuleBroken{"HOME_CLEAR", "clear_counts = 21", "clear_counts = 19", "clear_counts = 19",
                   "axis.yaw.homing.clear_counts"},
        RuleBroken{"HOME_TOLERANCE", "tolerance_counts = 4", "tolerance_counts = 2", "tolerance_counts = 2",
                   "axis.yaw.homing.tolerance_counts"},
        RuleBroken{"HYSTERESIS", "hysteresis_counts = 3", "hysteresis_counts = 124",
                   "hysteresis_counts = 124", "axis.yaw.homing.hysteresis_counts"},
        RuleBroken{"HOME_TIMEOUT", "timeout_ms = 34000", "timeout_ms = 3400", "timeout_ms = 3400",
                   "axis.yaw.homing.timeout_ms"},
        RuleBroken{"SPEED", "slow_speed_counts_per_s = 12", "slow_speed_counts_per_s = 61",
                   "slow_speed_counts_per_s = 61", "axis.yaw.homing.slow_speed_counts_per_s"},
        RuleBroken{"STALL", "driven_ms = 500", "driven_ms = 501", "driven_ms = 501", "axis.yaw.stall"},
        RuleBroken{"REVERSE", "reverse_counts = 20", "reverse_counts = 11", "reverse_counts = 11",
                   "axis.yaw.runaway.reverse_counts"},
        RuleBroken{"DRIFT", "drift_counts = 20", "drift_counts = 11", "drift_counts = 11",
                   "axis.yaw.runaway.drift_counts"},
        RuleBroken{"STALL_EFFORT", "effort_ms = 68", "effort_ms = 62", "effort_ms = 62",
                   "axis.yaw.stall.effort_ms"},
        RuleBroken{"NOISE", "noise_counts = 1", "noise_counts = 124", "noise_counts = 124",
                   "axis.yaw.mechanics.noise_counts"},
        RuleBroken{"REST", "rest_ms = 50", "rest_ms = 2", "rest_ms = 2", "axis.yaw.mechanics.rest_ms"},
        RuleBroken{"MAX_DELTA", "max_delta_counts = 8", "max_delta_counts = 0", "max_delta_counts = 0",
                   "axis.yaw.mechanics.max_delta_counts"}),
    [](const auto& broken) { return std::string(broken.param.rule); });

/** A step of homing that a sound file with the step "away" before "base" refuses. */
RobotError with_step(const std::string& travel) {
  const std::string base = "[[home_step]]\nname = \"base\"";
  const std::string away = "[[home_step]]\nname = \"away\"\ntitle = \"Away\"\n" + travel + "\n";
  const std::string text = test::neuro_with(base, away + base);
  const auto config = compile(parse_robot(text, "broken.toml").value());
  EXPECT_FALSE(config);
  RobotError error = config ? RobotError{} : config.error();
  EXPECT_EQ(error.line, test::line_of(text, travel));
  return error;
}

TEST(HomeSteps, move_to_setpoints_that_the_kernel_accepts_only) {
  const RobotError error = with_step("move = { insertion = 11 }");
  EXPECT_EQ(error.key, "home_step.away.move.insertion");
  EXPECT_EQ(error.expected, "counts from 12 to 1638");
}

TEST(HomeSteps, nudge_by_the_range_of_the_axis_at_most) {
  const RobotError error = with_step("nudge = { lateral = 2338 }");
  EXPECT_EQ(error.key, "home_step.away.nudge.lateral");
  EXPECT_EQ(error.expected, "counts from -2337 to 2337");
}

TEST(ConfigFile, holds_the_words_least_significant_byte_first) {
  ilk_config_t config{};
  config.common.version = 0x04030201;
  const ConfigBytes bytes = encode(config);
  EXPECT_EQ(bytes[0], 1);
  EXPECT_EQ(bytes[1], 2);
  EXPECT_EQ(bytes[2], 3);
  EXPECT_EQ(bytes[3], 4);
}

TEST(ConfigFile, decodes_to_the_configuration_that_was_encoded) {
  const ilk_config_t config = compile(test::neuro()).value();
  const ilk_config_t again = decode(encode(config));
  EXPECT_EQ(std::memcmp(&again, &config, sizeof config), 0);
}

class ConfigFileOnDisk : public testing::Test {
 protected:
  ConfigFileOnDisk() { std::filesystem::create_directories(folder_); }
  ~ConfigFileOnDisk() override { std::filesystem::remove_all(folder_); }

  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("interlock-robot-tests-" + std::to_string(getpid()));
};

TEST_F(ConfigFileOnDisk, is_the_encoded_configuration_and_nothing_else) {
  const ilk_config_t config = compile(test::neuro()).value();
  const std::filesystem::path file = folder_ / "neuro.ilkc";
  ASSERT_TRUE(write_config(config, file));
  ASSERT_TRUE(write_config(config, file)) << "writing again replaces it";

  ConfigBytes bytes{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(reinterpret_cast<char*>(bytes.data()), bytes.size());
  EXPECT_EQ(bytes, encode(config));
  EXPECT_EQ(std::filesystem::file_size(file), bytes.size());
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
}

TEST_F(ConfigFileOnDisk, that_cannot_be_written_is_named) {
  const auto written = write_config(compile(test::neuro()).value(), folder_ / "missing" / "neuro.ilkc");
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error(), HasSubstr("missing/neuro.ilkc"));
  EXPECT_THAT(written.error(), HasSubstr("No such file or directory"));
}

TEST(ConfigHash, is_eight_hex_digits_of_the_crc) {
  ilk_config_t config{};
  config.crc = 0xab;
  EXPECT_EQ(config_hash(config), "000000ab");
}

}  // namespace
}  // namespace interlock
