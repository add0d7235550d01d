#include "robot/robot_file.hpp"

#include <gmock/gmock.h>

#include "kinematics/neuro_rcm/neuro_kinematics.hpp"
#include "neuro.hpp"

namespace interlock {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(RobotFile, neuro_has_the_published_axes_in_the_published_order) {
  std::vector<std::string> names;
  for (const Axis& axis : test::neuro().axes) {
    names.push_back(axis.name);
  }
  EXPECT_THAT(names, ElementsAre("yaw", "probe_rotation", "pitch", "insertion", "lateral", "head", "feet"));
}

TEST(RobotFile, neuro_reads_as_written) {
  const Robot robot = test::neuro();
  EXPECT_EQ(robot.name, "neuro");
  EXPECT_EQ(robot.period_us, 1000u);
  EXPECT_EQ(robot.pedal, (Pedal{2, 10, 50}));
  EXPECT_THAT(robot.modes, ElementsAre("manual", "home", "coordinated", "trajectory", "draping", "ablation"));
  EXPECT_THAT(robot.draping,
              ElementsAre(AxisCounts{6, 0}, AxisCounts{7, -3543}, AxisCounts{2, 358}, AxisCounts{0, -597}));
  EXPECT_EQ(robot.find("yaw")->motion, (MotionRates{600.0, 6000.0, 120000.0, 40}));
  EXPECT_FALSE(robot.auto_approve);
  EXPECT_EQ(robot.loop, (LoopLimits{100, 100, 20, 5, 3, 3}));
  EXPECT_EQ(robot.family, "neuro_rcm");
  EXPECT_EQ(dynamic_cast<const NeuroKinematics&>(*robot.kinematics).geometry(),
            (NeuroRcm{60.0, 30.0, 143.0, 72.5, {18.32, 178.39, 72.91}, 75.0, 146.0}));
  EXPECT_EQ(robot.probe, (ProbeOffsets{10.0, 5.0, 5.0, 41.0}));
  EXPECT_THAT(robot.sensors, testing::IsEmpty());
  EXPECT_THAT(robot.home_steps, ElementsAre(HomeStep{"probe_out", "Probe out", {3}, {}, {}},
                                            HomeStep{"angles", "Angles", {0, 2}, {}, {}},
                                            HomeStep{"base", "Base", {4, 7}, {}, {}}));

  const Axis& pitch = *robot.find("pitch");
  EXPECT_EQ(pitch.slot, 2u);
  EXPECT_EQ(pitch.title, "Pitch");
  EXPECT_EQ(pitch.role, "pitch");
  EXPECT_EQ(pitch.card, ILK_CARD_NON_PWM);
  EXPECT_FALSE(pitch.required);
  EXPECT_EQ(pitch.motor, Motor::shinsei);
  EXPECT_EQ(pitch.encoder_resolution, 5000u);
  EXPECT_EQ(pitch.unit, Unit::rad);
  EXPECT_EQ(pitch.counts_per_unit, 795.8);
  EXPECT_EQ(pitch.motor_direction, 0u);
  EXPECT_EQ(pitch.direction_correction, 1u);
  EXPECT_EQ(pitch.limit, ILK_LIMIT_UPPER);
  EXPECT_EQ(pitch.home_offset_counts, 516);
  EXPECT_EQ(pitch.deadband_counts, 1u);
  EXPECT_EQ(pitch.unhomed_travel_counts, 70u);
  EXPECT_EQ(pitch.soft_limits, (SoftLimits{-370, 516}));
  EXPECT_EQ(pitch.drive, (DriveBounds{0x1ffff, 0, 1967, 13107, 0}));
  EXPECT_EQ(pitch.gains, (Gains{15.0, 0.3, 4.0}));
  EXPECT_EQ(pitch.mechanics, (Mechanics{12, 1, 1, 8, 50, 1000}));
  EXPECT_EQ(pitch.stall, (StallRule{500, 68, 2}));
  EXPECT_EQ(pitch.runaway, (RunawayRule{20, 20}));
  EXPECT_EQ(pitch.homing, (Homing{13107, 0, 4752, 60, 12, 1142, 28000, 21, 4, 3}));
  EXPECT_EQ(robot.find("feet")->homing, std::nullopt);
}

TEST(RobotFile, reading_twice_gives_equal_axes) { EXPECT_EQ(test::neuro().axes, test::neuro().axes); }

TEST(RobotFile, what_calibration_leaves_is_not_stated_unless_the_file_does) {
  EXPECT_EQ(test::neuro().calibration_mm, std::nullopt);
  const auto robot =
      parse_robot(test::neuro_with("[kinematics]\n", "[kinematics]\ncalibration_mm = 0.25\n"), "neuro.toml");
  ASSERT_TRUE(robot) << robot.error().message();
  EXPECT_EQ(robot->calibration_mm, 0.25);
}

TEST(RobotFile, play_of_a_tool_is_not_known_unless_the_file_states_it_and_needs_room_to_be_taken_up) {
  Axis yaw = *test::neuro().find("yaw");
  EXPECT_EQ(yaw.mechanics.tool_play_counts, std::nullopt);
  EXPECT_EQ(yaw.take_up_counts(-300), std::nullopt);
  const auto robot = parse_robot(test::neuro_with("full_speed_counts_per_s = 1000,",
                                                  "full_speed_counts_per_s = 1000, tool_play_counts = 4,"),
                                 "neuro.toml");
  ASSERT_TRUE(robot) << robot.error().message();
  yaw = *robot->find("yaw");
  EXPECT_EQ(yaw.mechanics.tool_play_counts, 4u);
  EXPECT_EQ(yaw.take_up_counts(-300), -307)
      << "and by a deadband of one at each end, and the edge of a count";
  EXPECT_EQ(yaw.take_up_counts(yaw.lowest_setpoint_counts() + 6), std::nullopt);
  EXPECT_EQ(yaw.take_up_counts(yaw.lowest_setpoint_counts() + 7), yaw.lowest_setpoint_counts());
}

TEST(RobotFile, milliseconds_become_periods_of_the_robot) {
  const auto robot = parse_robot(test::neuro_with("period_us = 1000", "period_us = 500"), "fast.toml");
  ASSERT_TRUE(robot) << robot.error().message();
  EXPECT_EQ(robot->pedal.debounce_ticks, 20u);
  EXPECT_EQ(robot->find("yaw")->homing->timeout_ticks, 68000u);
}

TEST(RobotFile, a_high_frequency_axis_has_amplitudes) {
  std::string text = test::neuro_with("card = \"pwm\"", "card = \"high-frequency\"");
  const auto replace = [&text](std::string_view from, std::string_view to) {
    text.replace(text.find(from), from.size(), to);
  };
  replace("unhomed_max = 6143", "unhomed_max = 6143, max_amplitude = 200, resonance_hz = -150");
  replace("speed_counts_per_s = 60", "speed_counts_per_s = 60\namplitude = 100");
  const auto robot = parse_robot(text, "piezo.toml");
  ASSERT_TRUE(robot) << robot.error().message();
  EXPECT_EQ(robot->find("yaw")->drive.max_amplitude, 200u);
  EXPECT_EQ(robot->find("yaw")->drive.resonance_hz, -150.0);
  EXPECT_EQ(robot->find("yaw")->homing->amplitude, 100u);
}

TEST(RobotFile, an_axis_may_be_required) {
  const auto robot = parse_robot(test::neuro_with("slot = 3", "slot = 3\nrequired = true"), "required.toml");
  ASSERT_TRUE(robot) << robot.error().message();
  EXPECT_TRUE(robot->find("insertion")->required);
}

TEST(RobotFile, a_file_that_is_not_there_is_named) {
  const auto robot = load_robot("/nowhere/neuro.toml");
  ASSERT_FALSE(robot);
  EXPECT_EQ(robot.error().file, "/nowhere/neuro.toml");
  EXPECT_THAT(robot.error().message(), HasSubstr("cannot be read"));
  EXPECT_TRUE(robot.error().is_missing) << "which is no refusal of what it says";
  EXPECT_FALSE(parse_robot("", "empty.toml").error().is_missing);
}

TEST(RobotFile, a_folder_is_no_robot_file) { EXPECT_FALSE(load_robot(INTERLOCK_ROBOTS)); }

TEST(RobotFile, a_device_that_never_ends_is_no_robot_file) { EXPECT_FALSE(load_robot("/dev/zero")); }

/** One way to break the neuro robot's file: what is replaced, by what, and what the error must say. */
struct Broken {
  const char* title;
  const char* from;
  const char* to;
  const char* at; /**< text of the line that the error must point to */
  const char* key;
  const char* problem;
  const char* expected;
};

void PrintTo(const Broken& broken, std::ostream* stream) { *stream << broken.title; }

class BrokenRobotFile : public testing::TestWithParam<Broken> {};

TEST_P(BrokenRobotFile, is_refused_with_file_line_key_and_what_was_expected) {
  const std::string text = test::neuro_with(GetParam().from, GetParam().to);
  const auto robot = parse_robot(text, "broken.toml");
  ASSERT_FALSE(robot);
  EXPECT_EQ(robot.error().file, "broken.toml");
  EXPECT_EQ(robot.error().line, test::line_of(text, GetParam().at)) << robot.error().message();
  EXPECT_EQ(robot.error().key, GetParam().key);
  EXPECT_THAT(robot.error().problem, HasSubstr(GetParam().problem));
  EXPECT_THAT(robot.error().expected, HasSubstr(GetParam().expected));
}

INSTANTIATE_TEST_SUITE_P(
    Each, BrokenRobotFile,
    testing::Values(
        Broken{"not_toml", "slot = 3", "slot = = 3", "slot = = 3", "", "", "a TOML file"},
        Broken{"key_twice", "slot = 3", "slot = 3\nslot = 5", "slot = 5", "", "slot", "a TOML file"},
        Broken{"missing_name", "name = \"neuro\"\n", "", "", "name", "missing",
               "a name of lower-case letters"},
        Broken{"name_with_space", "name = \"neuro\"", "name = \"neuro robot\"", "name = \"neuro robot\"",
               "name", "neuro robot", "a name of lower-case letters"},
        Broken{"empty_title", "title = \"Pitch\"", "title = \"\"", "title = \"\"", "axis.pitch.title",
               "is given", "text that is not empty"},
        Broken{"unknown_key_of_the_robot", "period_us = 1000", "period_us = 1000\nperiod_ms = 1", "period_ms",
               "period_ms", "unknown", "period_us"},
        Broken{"unknown_key_of_an_axis", "title = \"Pitch\"", "title = \"Pitch\"\ndead_band = 2", "dead_band",
               "axis.pitch.dead_band", "unknown", "deadband_counts"},
        Broken{"unknown_key_of_a_table", "velocity = 0.3,", "velocity = 0.3, kx = 1.0,", "kx = 1.0",
               "axis.yaw.gains.kx", "unknown", "integral_per_s, position_per_s, velocity"},
        Broken{"pedal_is_no_table", "[pedal]\nchannels = 2\ndebounce_ms = 10\ndisagree_ms = 50", "pedal = 2",
               "pedal = 2", "pedal", "2 is given", "a table"},
        Broken{"missing_table", "stall = { driven_ms = 500, effort_ms = 68, min_counts = 2 }\n", "",
               "[[axis]]", "axis.yaw.stall", "missing", "a table"},
        Broken{"slot_out_of_range", "slot = 3", "slot = 10", "slot = 10", "axis.insertion.slot",
               "10 is given", "a whole number from 0 to 9"},
        Broken{"slot_as_text", "slot = 3", "slot = \"3\"", "slot = \"3\"", "axis.insertion.slot", "3",
               "a whole number from 0 to 9"},
        Broken{"slot_taken_twice", "slot = 3", "slot = 1", "slot = 1\nrole = \"insertion\"",
               "axis.insertion.slot", "probe_rotation", "a slot of its own"},
        Broken{"name_taken_twice", "name = \"feet\"", "name = \"head\"",
               "name = \"head\"\ntitle = \"Axial feet\"", "axis.head.name", "\"head\"", "a name of its own"},
        Broken{"fraction_of_a_count", "min_counts = -1222", "min_counts = -1222.5", "min_counts = -1222.5",
               "axis.yaw.soft_limits.min_counts", "-1222.5", "a whole number"},
        Broken{"limit_beyond_32_bits", "max_counts = 8 ", "max_counts = 4294967296 ", "4294967296",
               "axis.yaw.soft_limits.max_counts", "4294967296", "1073741824"},
        Broken{"negative_coast", "coast_counts = 12", "coast_counts = -12", "coast_counts = -12",
               "axis.yaw.mechanics.coast_counts", "-12", "0 to 4294967295"},
        Broken{"unknown_card", "card = \"non-pwm\"", "card = \"spi\"", "card = \"spi\"", "axis.pitch.card",
               "spi", "\"pwm\", \"non-pwm\", \"analog-input\", \"high-frequency\""},
        Broken{"card_as_number", "card = \"non-pwm\"", "card = 2", "card = 2", "axis.pitch.card",
               "2 is given", "one of"},
        Broken{"unit_of_people", "unit = \"mm\"", "unit = \"deg\"", "unit = \"deg\"", "axis.insertion.unit",
               "deg", "\"mm\", \"rad\""},
        Broken{"no_counts_per_unit", "counts_per_unit = 47.24", "counts_per_unit = 0.0",
               "counts_per_unit = 0.0", "axis.insertion.counts_per_unit", "0 is given", "from 1e-09 to"},
        Broken{"counts_per_unit_not_a_number", "counts_per_unit = 47.24", "counts_per_unit = nan",
               "counts_per_unit = nan", "axis.insertion.counts_per_unit", "nan", "a finite number"},
        Broken{"rate_of_zero", "velocity_counts_per_s = 600", "velocity_counts_per_s = 0.0",
               "velocity_counts_per_s = 0.0", "axis.yaw.motion.velocity_counts_per_s", "0 is given",
               "1e-6 to 1e6 rad/s"},
        Broken{"rate_below_zero", "jerk_counts_per_s3 = 120000", "jerk_counts_per_s3 = -1",
               "jerk_counts_per_s3 = -1", "axis.yaw.motion.jerk_counts_per_s3", "-1 is given",
               "1e-6 to 1e6 rad/s^3"},
        Broken{"rate_that_is_no_number", "acceleration_counts_per_s2 = 6000",
               "acceleration_counts_per_s2 = nan", "acceleration_counts_per_s2 = nan",
               "axis.yaw.motion.acceleration_counts_per_s2", "nan", "a finite number"},
        Broken{"rate_beyond_what_is_planned", "counts_per_unit = 795.8", "counts_per_unit = 0.01",
               "jerk_counts_per_s3 = 120000", "axis.yaw.motion.jerk_counts_per_s3", "120000 is given",
               "1e-08 to 10000: 1e-6 to 1e6 rad/s^3"},
        Broken{"velocity_that_never_arrives", "velocity_counts_per_s = 600", "velocity_counts_per_s = 0.1",
               "velocity_counts_per_s = 0.1", "axis.yaw.motion.velocity_counts_per_s",
               "0.1 is given: the whole range takes 12300", "7600 s at most"},
        Broken{"acceleration_without_effect", "acceleration_counts_per_s2 = 6000",
               "acceleration_counts_per_s2 = 600001", "acceleration_counts_per_s2 = 600001",
               "axis.yaw.motion.acceleration_counts_per_s2", "less than 1 ms", "at most 600000"},
        Broken{"jerk_without_effect", "jerk_counts_per_s3 = 120000", "jerk_counts_per_s3 = 6000001",
               "jerk_counts_per_s3 = 6000001", "axis.yaw.motion.jerk_counts_per_s3", "less than 1 ms",
               "at most 6e+06"},
        Broken{"counts_per_unit_of_almost_nothing", "counts_per_unit = 795.8", "counts_per_unit = 1e-9",
               "counts_per_unit = 1e-9", "axis.yaw.counts_per_unit", "1e-09 is given: the soft limits",
               "at least 0.001222"},
        Broken{"negative_gain", "integral_per_s = 4.0", "integral_per_s = -1.0", "integral_per_s = -1.0",
               "axis.yaw.gains.integral_per_s", "-1 is given", "from 0 to"},
        Broken{"least_drive_above_largest", "min = 0xFFF,", "min = 0xF000,", "min = 0xF000",
               "axis.yaw.drive.min", "is given", "from 0 to 61439"},
        Broken{"polarity_as_boolean", "motor_direction = 0", "motor_direction = false",
               "motor_direction = false", "axis.pitch.motor_direction", "false", "from 0 to 1"},
        Broken{"required_as_number", "slot = 3", "slot = 3\nrequired = 1", "required = 1",
               "axis.insertion.required", "1 is given", "true or false"},
        Broken{"time_between_periods", "period_us = 1000", "period_us = 1500", "debounce_ms",
               "pedal.debounce_ms", "10 ms is not a whole number of control periods",
               "a multiple of period_us = 1500"},
        Broken{"time_beyond_32_bits", "timeout_ms = 34000", "timeout_ms = 4294968", "timeout_ms = 4294968",
               "axis.yaw.homing.timeout_ms", "4294968", "from 0 to 4294967"},
        Broken{"homing_without_switch", "limit = \"lower\"", "limit = \"none\"",
               "[axis.homing]\ndrive = 13107\nslow_drive = 4752\nspeed_counts_per_s = "
               "60\nslow_speed_counts_per_s = 12\n"
               "travel_counts = 1921",
               "axis.insertion.homing", "no switch", "no homing table"},
        Broken{"switch_without_homing", "limit = \"none\"", "limit = \"upper\"",
               "[[axis]]\nname = \"probe_rotation\"", "axis.probe_rotation.homing", "missing", "a table"},
        Broken{"amplitude_on_a_pwm_card", "unhomed_max = 6143", "unhomed_max = 6143, max_amplitude = 5",
               "max_amplitude = 5", "axis.yaw.drive.max_amplitude", "unknown",
               "dead_zone, max, min, unhomed_max"},
        Broken{"step_homes_no_axis", R"(home = ["insertion"])", R"(home = ["needle"])", R"(["needle"])",
               "home_step.probe_out.home", "no axis is called \"needle\"", "axes with a switch"},
        Broken{"step_homes_an_axis_without_switch", R"(home = ["insertion"])",
               R"(home = ["insertion", "feet"])", R"("feet"])", "home_step.probe_out.home",
               "\"feet\" has no switch", "axes with a switch"},
        Broken{"step_homes_an_axis_again", R"(home = ["yaw", "pitch"])", R"(home = ["yaw", "insertion"])",
               R"("yaw", "insertion"])", "home_step.angles.home", "\"insertion\" homes twice",
               "no other step homes"},
        Broken{"step_homes_nothing", R"(home = ["insertion"])", "home = []", "home = []",
               "home_step.probe_out.home", "names no axis", "at least one"},
        Broken{"step_homes_a_number", R"(home = ["insertion"])", "home = [3]", "home = [3]",
               "home_step.probe_out.home", "3 is given", "names of axes"},
        Broken{"no_step_homes_the_head", R"(home = ["lateral", "head"])", R"(home = ["lateral"])",
               "[[home_step]]", "home_step", "no step homes \"head\"", "every axis with a switch"},
        Broken{"step_without_travel", R"(home = ["insertion"])", "", "[[home_step]]", "home_step.probe_out",
               "none or several", "exactly one"},
        Broken{"step_with_two_travels", R"(home = ["insertion"])",
               "home = [\"insertion\"]\nmove = { insertion = 500 }", "[[home_step]]", "home_step.probe_out",
               "none or several", "exactly one"},
        Broken{"step_with_the_name_of_another", "name = \"base\"", "name = \"angles\"",
               "name = \"angles\"\ntitle = \"Base\"", "home_step.angles.name", "called \"angles\" already",
               "a name of its own"},
        Broken{"nudge_of_an_unknown_axis", R"(home = ["insertion"])", "nudge = { needle = 50 }",
               "nudge = { needle", "home_step.probe_out.nudge.needle", "no axis is called", "one of yaw"},
        Broken{"nudge_of_an_axis_without_switch", R"(home = ["insertion"])", "nudge = { feet = 50 }",
               "nudge = { feet", "home_step.probe_out.nudge.feet", "no switch",
               "an axis that a later step homes"},
        Broken{"nudge_of_an_axis_that_is_homed", R"(home = ["lateral", "head"])",
               "nudge = { insertion = 50 }", "nudge = { insertion", "home_step.base.nudge.insertion",
               "homed by then", "an axis that a later step homes"},
        Broken{"nudge_by_nothing", R"(home = ["insertion"])", "nudge = { insertion = 0 }",
               "nudge = { insertion", "home_step.probe_out.nudge.insertion", "no travel",
               "a signed distance"},
        Broken{"nudge_of_no_axis", R"(home = ["insertion"])", "nudge = {}", "nudge = {}",
               "home_step.probe_out.nudge", "names no axis", "at least one axis"},
        Broken{"move_of_an_axis_that_is_not_homed", R"(home = ["insertion"])", "move = { insertion = 500 }",
               "move = { insertion", "home_step.probe_out.move.insertion", "not homed by then",
               "an axis that an earlier step homes"},
        Broken{"move_of_an_axis_without_switch", R"(home = ["lateral", "head"])", "move = { feet = 0 }",
               "move = { feet", "home_step.base.move.feet", "not homed by then",
               "an axis that an earlier step homes"},
        Broken{"order_of_homing_without_steps", "period_us = 1000", "period_us = 1000\nhome_order = []",
               "home_order", "home_order", "unknown", "home_step"}),
    [](const auto& broken) { return std::string(broken.param.title); });

TEST(RobotFile, a_step_may_nudge_what_homes_later_and_move_what_homed_before) {
  const auto robot = parse_robot(
      test::neuro_with(
          "[[home_step]]\nname = \"base\"",
          "[[home_step]]\nname = \"away\"\ntitle = \"Away\"\nnudge = { lateral = -200, head = 900 }\n"
          "[[home_step]]\nname = \"in\"\ntitle = \"In\"\nmove = { insertion = 12 }\n"
          "[[home_step]]\nname = \"base\""),
      "steps.toml");
  ASSERT_TRUE(robot) << robot.error().message();
  EXPECT_EQ(robot->home_steps.at(2), (HomeStep{"away", "Away", {}, {{7, 900}, {4, -200}}, {}}));
  EXPECT_EQ(robot->home_steps.at(3), (HomeStep{"in", "In", {}, {}, {{3, 12}}}));
}

TEST(RobotFile, a_robot_without_switches_needs_no_steps) {
  std::istringstream lines(test::neuro_text());
  std::string text;
  bool about_homing = false;
  for (std::string line; std::getline(lines, line);) {
    about_homing = line.starts_with('[') ? line == "[axis.homing]" || line == "[[home_step]]" : about_homing;
    if (line.starts_with("limit =")) {
      line = "limit = \"none\"";
    } else if (line.starts_with("modes =")) {
      line = "modes = [\"manual\"]";
    }
    text += about_homing ? "" : line + '\n';
  }
  const auto robot = parse_robot(text, "by_hand.toml");
  ASSERT_TRUE(robot) << robot.error().message();
  EXPECT_THAT(robot->home_steps, testing::IsEmpty());
}

/** The neuro robot's file with an [openigtlink] table of these lines. */
std::string with_openigtlink(const std::string& lines) {
  return test::neuro_text() + "\n[openigtlink]\n" + lines;
}

constexpr const char* usual_openigtlink = "bind = \"127.0.0.1\"\nport = 18944\ndialect = \"thesis\"\n";

TEST(RobotFile, openigtlink_reads_as_written) {
  const auto robot = parse_robot(
      with_openigtlink("bind = \"0.0.0.0\"\nport = 1\ndialect = \"wpi2024\"\nallow = [\"10.0.0.7\"]\n"
                       "heartbeat_ms = 200\nconnect = \"10.0.0.8:65535\"\nfirst_controls = true\n"),
      "igtl.toml");
  ASSERT_TRUE(robot) << robot.error().message();
  EXPECT_EQ(robot->openigtlink,
            (OpenIgtLink{"0.0.0.0", 1, "wpi2024", {"10.0.0.7"}, 200, "10.0.0.8", 65535, true}));
  EXPECT_EQ(parse_robot(with_openigtlink(usual_openigtlink), "igtl.toml")->openigtlink, OpenIgtLink{});
  EXPECT_FALSE(test::neuro().openigtlink.has_value());
}

TEST(RobotFile, a_broken_key_of_openigtlink_is_named) {
  const std::string usual = usual_openigtlink;
  const std::vector<std::pair<std::string, std::string>> broken{
      {"port = 1\ndialect = \"thesis\"\n", "bind"},
      {"bind = \"\"\nport = 1\ndialect = \"thesis\"\n", "bind"},
      {"bind = \"::1\"\nport = 0\ndialect = \"thesis\"\n", "port"},
      {"bind = \"::1\"\nport = 65536\ndialect = \"thesis\"\n", "port"},
      {"bind = \"::1\"\nport = 1\ndialect = \"Thesis\"\n", "dialect"},
      {"bind = \"::1\"\nport = 1\n", "dialect"},
      {usual + "allow = \"10.0.0.7\"\n", "allow"},
      {usual + "heartbeat_ms = 49\n", "heartbeat_ms"},
      {usual + "connect = \"10.0.0.7\"\n", "connect"},
      {usual + "connect = \":18944\"\n", "connect"},
      {usual + "connect = \"10.0.0.7:\"\n", "connect"},
      {usual + "connect = \"10.0.0.7:0\"\n", "connect"},
      {usual + "connect = \"10.0.0.7:65536\"\n", "connect"},
      {usual + "connect = \"10.0.0.7:80x\"\n", "connect"},
      {usual + "first_controls = 1\n", "first_controls"},
      {usual + "colour = 1\n", "colour"}};
  for (const auto& [lines, key] : broken) {
    const auto robot = parse_robot(with_openigtlink(lines), "igtl.toml");
    ASSERT_FALSE(robot) << lines;
    EXPECT_EQ(robot.error().key, "openigtlink." + key) << lines;
    EXPECT_FALSE(robot.error().expected.empty()) << lines;
  }
}

TEST(RobotFile, an_axis_that_is_no_table_is_refused) {
  const std::string text = test::neuro_text();
  const std::string head = text.substr(0, text.find("[[axis]]"));
  const auto robot = parse_robot("axis = [1, 2]\n" + head, "broken.toml");
  ASSERT_FALSE(robot);
  EXPECT_EQ(robot.error().line, 1u);
  EXPECT_EQ(robot.error().key, "axis[0]");
}

/** A reader of files from anywhere must end with an answer, wherever the file breaks off. */
TEST(RobotFile, a_file_that_breaks_off_is_answered_everywhere) {
  const std::string text = test::neuro_text();
  const std::size_t last_key = text.rfind("home = ");
  for (std::size_t length = 0; length < last_key; length += 7) {
    const auto robot = parse_robot(std::string_view(text).substr(0, length), "short.toml");
    ASSERT_FALSE(robot) << length;
    ASSERT_FALSE(robot.error().expected.empty()) << length;
  }
}

TEST(RobotFile, bytes_that_are_no_text_are_refused) {
  const auto robot = parse_robot("name = \"\xff\xfe\"", "bytes.toml");
  ASSERT_FALSE(robot);
  EXPECT_EQ(robot.error().line, 1u);
}

TEST(RobotFile, an_empty_file_names_the_first_missing_key) {
  const auto robot = parse_robot("", "empty.toml");
  ASSERT_FALSE(robot);
  EXPECT_EQ(robot.error().key, "name");
}

TEST(RobotRole, is_played_by_one_axis_only) {
  const auto robot = parse_robot(test::neuro_with("role = \"feet\"", "role = \"head\""), "broken.toml");
  ASSERT_FALSE(robot);
  EXPECT_EQ(robot.error().key, "axis.feet.role");
  EXPECT_EQ(robot.error().problem, "\"head\" plays \"head\" already");
}

TEST(RobotRole, left_out_is_the_one_of_the_axis_own_name) {
  const auto robot = parse_robot(test::neuro_with("role = \"feet\"\n", ""), "neuro.toml");
  ASSERT_TRUE(robot) << robot.error().message();
  EXPECT_EQ(robot->find("feet")->role, "feet");
}

TEST(RobotRole, of_the_family_is_played_by_some_axis) {
  const auto robot =
      parse_robot(test::neuro_with("name = \"feet\"\ntitle = \"Axial feet\"\nslot = 6\nrole = \"feet\"",
                                   "name = \"foot\"\ntitle = \"Axial feet\"\nslot = 6"),
                  "broken.toml");
  ASSERT_FALSE(robot);
  EXPECT_EQ(robot.error().key, "kinematics");
  EXPECT_EQ(robot.error().problem, "no axis plays \"feet\"");
}

TEST(RobotRole, is_played_in_its_unit) {
  const auto robot = parse_robot(test::neuro_with("unit = \"rad\"", "unit = \"mm\""), "broken.toml");
  ASSERT_FALSE(robot);
  EXPECT_EQ(robot.error().key, "axis.yaw.role");
  EXPECT_EQ(robot.error().problem, "\"yaw\" needs an axis in rad");
}

TEST(RobotRole, may_be_none) {
  std::string text = test::neuro_text();
  const std::size_t feet = text.find("[[axis]]\nname = \"feet\"");
  std::string spare = text.substr(feet, text.find("# The published setpoints") - feet);
  for (const auto& [from, to] : {std::pair{"\"feet\"\ntitle", "\"spare\"\ntitle"},
                                 std::pair{"slot = 6", "slot = 9"}, std::pair{"role = \"feet\"\n", ""}}) {
    spare.replace(spare.find(from), std::string_view(from).size(), to);
  }
  const auto robot = parse_robot(text.insert(feet, spare), "spare.toml");
  ASSERT_TRUE(robot) << robot.error().message();
  EXPECT_EQ(robot->at_slot(9)->role, "");
  EXPECT_EQ(robot->with_role("feet")->slot, 6u);
}

TEST(RobotError, reads_as_one_line_with_file_line_key_problem_and_expectation) {
  const RobotError error{"neuro.toml", 41, "axis.yaw.slot", "10 is given", "a whole number from 0 to 9"};
  EXPECT_EQ(error.message(),
            "neuro.toml:41: axis.yaw.slot: 10 is given; expected a whole number from 0 to 9");
}

}  // namespace
}  // namespace interlock
