#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "bench.hpp"
#include "plant/parameters_file.hpp"
#include "plant/robot_file.hpp"
#include "temporary_folder.hpp"

namespace interlock::plant::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kAxes = R"([[axis]]
slot = 0
name = "a"
start_from_switch_counts = 300
[[axis]]
slot = 2
name = "b"
start_counts = 0
[[axis]]
slot = 3
name = "c"
start_from_switch_counts = 300
[[axis]]
slot = 4
name = "d"
start_counts = 0
[[axis]]
slot = 5
name = "e"
start_counts = 0
)";

std::string fault_of_plant(const std::string& text) {
  const TemporaryFolder folder;
  const auto path = folder.write("p.toml", text);
  const auto loaded = load_parameters(path, sample_robot());
  return loaded ? "accepted" : loaded.error().substr(loaded.error().find("p.toml"));
}

std::string changed(const std::string& from, const std::string& to) {
  std::string text = kAxes;
  text.replace(text.find(from), from.size(), to);
  return text;
}

constexpr const char* kForceSensor = R"([[sensor]]
slot = 9
name = "force"
[[sensor.input]]
adc = 2
zero_counts = 1970
noise_counts = 3
)";

TEST(PlantFile, SensorHasTheInputsOfItsFile) {
  const TemporaryFolder folder;
  const auto loaded =
      load_parameters(folder.write("p.toml", std::string(kAxes) + kForceSensor), sample_robot());
  ASSERT_TRUE(loaded) << loaded.error();
  const SensorParameters& sensor = loaded->sensor[kSensor];
  EXPECT_EQ(sensor.name, "force");
  ASSERT_TRUE(sensor.input[1]);
  EXPECT_EQ(sensor.input[1]->zero_counts, 1970u);
  EXPECT_EQ(sensor.input[1]->noise_counts, 3u);
  EXPECT_FALSE(sensor.input[0] || sensor.input[2] || sensor.input[3]);
}

TEST(PlantFile, WrongSensorIsNamedWithItsLine) {
  const auto fault_with = [](const std::string& from, const std::string& to) {
    std::string text = std::string(kAxes) + kForceSensor;
    return fault_of_plant(text.replace(text.find(from), from.size(), to));
  };
  EXPECT_EQ(fault_with("slot = 9", "slot = 0"),
            "p.toml:21: slot: expected the slot of a sensor card of the robot, each once");
  EXPECT_THAT(fault_with("name = \"force\"\n", ""), HasSubstr("name: expected the name of the sensor"));
  EXPECT_THAT(fault_with("adc = 2", "adc = 5"), HasSubstr("p.toml:25: adc: expected a number from 1 to 4"));
  EXPECT_THAT(fault_with("zero_counts = 1970\n", ""), HasSubstr("zero_counts: expected the reading"));
  EXPECT_THAT(fault_with("noise_counts", "noise"), HasSubstr("p.toml:27: noise: unknown key"));
}

TEST(PlantFile, DefaultsApplyToEveryAxisAndAnAxisOverridesThem) {
  const TemporaryFolder folder;
  const auto path = folder.write(
      "p.toml", std::string("[pedal]\nlag_ms = 2.5\n[defaults]\nlag_ms = 7\nnoise_counts = 0\n") + kAxes +
                    "lag_ms = 9\n");
  const auto loaded = load_parameters(path, sample_robot());
  ASSERT_TRUE(loaded) << loaded.error();
  EXPECT_EQ(loaded->pedal.lag, Microseconds{2500});
  EXPECT_EQ(loaded->pedal.bounce, PedalParameters{}.bounce);
  EXPECT_EQ(loaded->axis[kPwm].lag, Microseconds{7000});
  EXPECT_EQ(loaded->axis[kPwm].noise_counts, 0u);
  EXPECT_EQ(loaded->axis[kPwm].start_counts, -300) << "300 below the switch at the upper end";
  EXPECT_EQ(loaded->axis[kLower].start_counts, 300) << "300 above the switch at the lower end";
  EXPECT_EQ(loaded->axis[kHighFrequency].lag, Microseconds{9000});
  EXPECT_EQ(loaded->axis[kHighFrequency].name, "e");
}

TEST(PlantFile, FaultNamesFileLineKeyAndWhatWasExpected) {
  EXPECT_EQ(fault_of_plant(changed("slot = 2", "slot = 12")),
            "p.toml:6: slot: expected a number from 0 to 9");
  EXPECT_EQ(fault_of_plant(changed("slot = 2", "slot = 2.5")), "p.toml:6: slot: expected a whole number");
  EXPECT_EQ(fault_of_plant(changed("slot = 2", "slot = 8")),
            "p.toml:5: slot: slot 8 of the robot has no motor card");
  EXPECT_EQ(fault_of_plant(changed("slot = 2", "slot = 9")),
            "p.toml:5: slot: slot 9 of the robot has no motor card");
  EXPECT_EQ(fault_of_plant(changed("slot = 2", "slot = 0")), "p.toml:5: slot: slot 0 has an axis already");
  EXPECT_EQ(fault_of_plant(changed("name = \"b\"\n", "")), "p.toml:5: name: expected the name of the axis");
  EXPECT_EQ(
      fault_of_plant(changed("name = \"b\"", "nane = \"b\"")),
      "p.toml:7: nane: unknown key; expected one of slot, name, start_counts, start_from_switch_counts, "
      "dead_zone_fraction, full_speed_counts_per_s, lag_ms, backlash_counts, tool_play_counts, "
      "load_fraction, "
      "heat_droop_fraction, heat_time_s, resonance_hz, resonance_drift_hz, noise_counts, noise_chance, "
      "counts_per_revolution, end_margin_counts, switch_hysteresis_counts, switch_bounce_ms");
  EXPECT_EQ(fault_of_plant(changed("start_counts = 0\n", "")),
            "p.toml:5: start_counts: expected either start_counts or start_from_switch_counts");
  EXPECT_EQ(fault_of_plant(changed("start_counts = 0", "start_from_switch_counts = 5")),
            "p.toml:5: start_from_switch_counts: the robot's axis has no switch; expected start_counts");
  EXPECT_EQ(fault_of_plant(changed("start_counts = 0", "start_counts = 9000")),
            "p.toml:5: start_counts: expected a start within the soft limits -8073 to 8073");
  EXPECT_EQ(fault_of_plant(changed("start_counts = 0", "start_counts = \"x\"")),
            "p.toml:8: start_counts: expected a number from -1.07374e+09 to 1.07374e+09");
  EXPECT_EQ(fault_of_plant(std::string("[defaults]\nlag_ms = nan\n") + kAxes),
            "p.toml:2: lag_ms: expected a number from 0.1 to 1000");
  EXPECT_EQ(fault_of_plant(std::string("pedal = 5\n") + kAxes), "p.toml:1: pedal: expected a table");
  EXPECT_THAT(fault_of_plant(""), HasSubstr("expected an [[axis]] for the motor card in slot 0"));
  EXPECT_THAT(fault_of_plant("[[axis]\n"), StartsWith("p.toml:1: "));
}

/** A plant file with a needle: one motor for all, and a sensor whose ADC 1 is connected. */
std::string needle_plant(const std::string& needle) {
  return "[[axis]]\nslot = 0\nname = \"a\"\nstart_counts = 0\n[[sensor]]\nslot = 3\nname = \"f\"\n"
         "[[sensor.input]]\nadc = 1\nzero_counts = 9\n" +
         needle;
}

std::string fault_of_needle(const std::string& needle) {
  ilk_config_t robot{};
  robot.axis[0].card = ILK_CARD_PWM;
  robot.axis[0].max_counts = 100;
  robot.axis[3].card = ILK_CARD_SENSOR;
  const TemporaryFolder folder;
  const auto loaded = load_parameters(folder.write("p.toml", needle_plant(needle)), robot);
  return loaded ? "" : loaded.error().substr(loaded.error().rfind("p.toml"));
}

const std::string kNeedle =
    "[needle]\n[needle.insertion]\nslot = 0\ncounts_per_unit = 5\n[needle.rotation]\nslot = 0\n"
    "counts_per_unit = 5\n[needle.hand]\nslot = 3\nadc = 1\ncounts_per_newton = 9\n[needle.tip]\nslot = 3\n"
    "adc = 1\ncounts_per_newton = 9\n";

TEST(PlantFile, ANeedleIsReadWithItsTissue) {
  EXPECT_EQ(fault_of_needle(kNeedle), "");
  EXPECT_EQ(fault_of_needle(kNeedle + "[[layer]]\ncutting_n = 1\n[[membrane]]\ndepth_mm = 4\n[target]\n"
                                      "position_mm = [1, 2, 3]\n[image]\nage_s = 0.5\n"),
            "");
}

TEST(PlantFile, AFaultOfNeedleOrTissueIsNamed) {
  EXPECT_EQ(fault_of_needle("[target]\nposition_mm = [1, 2, 3]\n"),
            "p.toml:11: target: there is no [needle] to work on it");
  EXPECT_EQ(fault_of_needle("[needle]\n"), "p.toml:11: insertion: expected a table [needle.insertion]");
  EXPECT_EQ(fault_of_needle(kNeedle + "[[membrane]]\ndepth_mm = 9\n[[membrane]]\ndepth_mm = 8\n"),
            "p.toml:29: depth_mm: expected a number from 9 to 1000");
  EXPECT_EQ(fault_of_needle(kNeedle + "[target]\nposition_mm = [1, 2]\n"),
            "p.toml:26: position_mm: expected three numbers in mm, in the guide frame");
  EXPECT_THAT(fault_of_needle(kNeedle + "[image]\nage_ms = 1\n"), HasSubstr("age_ms: unknown key"));
  std::string unread = kNeedle;
  unread.replace(unread.find("adc = 1"), 7, "adc = 2");
  EXPECT_THAT(fault_of_needle(unread), HasSubstr("adc: expected a connected input of a [[sensor]]"));
}

TEST(PlantFile, MissingFileIsNamed) {
  const auto loaded = load_parameters("/nonexistent/plant.toml", sample_robot());
  ASSERT_FALSE(loaded);
  EXPECT_THAT(loaded.error(), HasSubstr("/nonexistent/plant.toml"));
}

TEST(PlantFile, ProjectPlantsNameTheirAxes) {
  ilk_config_t robot{};
  const auto add = [&robot](std::size_t slot, ilk_limit_side_t side, int lower, int upper, int home) {
    robot.axis[slot].card = ILK_CARD_PWM;
    robot.axis[slot].limit_side = side;
    robot.axis[slot].min_counts = lower;
    robot.axis[slot].max_counts = upper;
    robot.axis[slot].home_offset_counts = home;
  };
  add(0, ILK_LIMIT_UPPER, -1222, 8, 0);
  add(1, ILK_LIMIT_NONE, -8073, 8073, 0);
  add(2, ILK_LIMIT_UPPER, -370, 516, 516);
  add(3, ILK_LIMIT_LOWER, 0, 1650, 0);
  add(4, ILK_LIMIT_UPPER, -2337, 0, 0);
  add(6, ILK_LIMIT_NONE, -5512, 5906, 0);
  add(7, ILK_LIMIT_UPPER, -11418, 0, 0);
  const auto neuro = load_parameters(std::filesystem::path(INTERLOCK_PLANTS) / "neuro.toml", robot);
  ASSERT_TRUE(neuro) << neuro.error();
  EXPECT_EQ(neuro->axis[0].name, "yaw");
  EXPECT_EQ(neuro->axis[7].name, "head");
}

TEST(RobotFile, IsReadAsItWasWritten) {
  const TemporaryFolder folder;
  write_robot(sample_robot(), folder / "r.ilkc");
  const auto robot = load_robot(folder / "r.ilkc");
  ASSERT_TRUE(robot) << robot.error();
  ilk_config_t expected = sample_robot();
  expected.crc = robot->crc;
  EXPECT_EQ(std::memcmp(&*robot, &expected, sizeof expected), 0);
}

TEST(RobotFile, RefusalNamesTheFileAndTheReason) {
  const TemporaryFolder folder;
  const auto fault = [&folder](const auto& change) {
    ilk_config_t robot = sample_robot();
    change(robot);
    write_robot(robot, folder / "r.ilkc");
    const auto loaded = load_robot(folder / "r.ilkc");
    return loaded ? std::string("accepted") : loaded.error();
  };
  EXPECT_THAT(fault([](auto& robot) { robot.common.version = 1; }), HasSubstr("r.ilkc: has version 1"));
  EXPECT_THAT(fault([](auto& robot) { robot.common.period_us = 100; }),
              HasSubstr("period 100 us, expected 125 to 2000"));
  EXPECT_THAT(fault([](auto& robot) { robot.axis[8].card = 6; }),
              HasSubstr("slot 8: card type 6 is unknown"));
  EXPECT_THAT(fault([](auto& robot) { robot.axis[0].limit_side = 3; }), HasSubstr("slot 0: limit side 3"));
  EXPECT_THAT(fault([](auto& robot) { robot.axis[0].min_counts = 8; }),
              HasSubstr("slot 0: soft limits 8 to 8"));
  EXPECT_THAT(fault([](auto& robot) { robot.axis[0].max_drive = 0; }), HasSubstr("slot 0: max_drive is 0"));
  EXPECT_THAT(fault([](auto& robot) { robot.axis[5].max_amplitude = 0; }),
              HasSubstr("slot 5: max_amplitude is 0"));
}

TEST(RobotFile, DamagedShortLongOrMissingFileIsRefused) {
  const TemporaryFolder folder;
  write_robot(sample_robot(), folder / "r.ilkc");
  std::ifstream file(folder / "r.ilkc", std::ios::binary);
  const std::string good{std::istreambuf_iterator<char>(file), {}};
  std::string damaged = good;
  damaged[100] = static_cast<char>(damaged[100] ^ 1);
  EXPECT_THAT(load_robot(folder.write("d", damaged)).error(), HasSubstr("its CRC does not match"));
  EXPECT_THAT(load_robot(folder.write("s", good.substr(1))).error(), HasSubstr("is no configuration of"));
  EXPECT_THAT(load_robot(folder.write("l", good + "x")).error(), HasSubstr("is no configuration of"));
  EXPECT_THAT(load_robot(folder / "none").error(), HasSubstr("cannot be read"));
}

}  // namespace
}  // namespace interlock::plant::test
