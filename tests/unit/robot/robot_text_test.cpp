#include "robot/robot_text.hpp"

#include <gtest/gtest.h>

#include <string>

namespace interlock {
namespace {

constexpr const char* text = R"(# Größe in counts
[[axis]]
name = "yaw"   # the first
drive = { max = 0xEFFF, min = 0, dead_zone = 922 }  # μ: measured

[axis.motion]
velocity_counts_per_s = 600

[[axis]]
name = "head"
gains = { position_per_s = 15.0, velocity = 0.3 }
drive = { max = 100, min = 0, dead_zone = 9 }
)";

std::string problem_of(std::string_view axis, const AxisNumber& number, std::string_view in = text) {
  const auto edited = with_numbers(in, "r.toml", axis, {&number, 1});
  return edited ? "" : edited.error().message();
}

TEST(RobotText, NumbersOfOneAxisChangeAndNothingElseDoes) {
  const AxisNumber numbers[] = {
      {"drive.dead_zone", 4000.0}, {"drive.max", 60000.0}, {"motion.velocity_counts_per_s", 420.0}};
  std::string expected = text;
  expected.replace(expected.find("600"), 3, "420");
  expected.replace(expected.find("922"), 3, "4000");
  expected.replace(expected.find("0xEFFF"), 6, "60000");
  EXPECT_EQ(with_numbers(text, "r.toml", "yaw", numbers).value(), expected);
}

TEST(RobotText, ANumberWithAFractionKeepsOne) {
  const AxisNumber numbers[] = {{"gains.position_per_s", 20.0}, {"gains.velocity", 0.133}};
  std::string expected = text;
  expected.replace(expected.find("15.0"), 4, "20.0");
  expected.replace(expected.find("0.3"), 3, "0.133");
  EXPECT_EQ(with_numbers(text, "r.toml", "head", numbers).value(), expected);
}

TEST(RobotText, ANumberOfTheWholeFileChangesAndAMissingOneIsWrittenBehindAnother) {
  const AxisNumber numbers[] = {{"axis[1].drive.dead_zone", 11.0}, {"axis[0].slot", 3.0, "axis[0].name"}};
  std::string expected = text;
  expected.replace(expected.rfind("dead_zone = 9"), 13, "dead_zone = 11");
  expected.insert(expected.find("\ndrive"), "\nslot = 3.0");
  EXPECT_EQ(with_numbers(text, "r.toml", "", numbers).value(), expected);
  const AxisNumber beside{"drive.resonance_hz", -200.0, "drive.max"};
  expected = text;
  expected.insert(expected.find(", min = 0, dead_zone = 922"), ", resonance_hz = -200.0");
  EXPECT_EQ(with_numbers(text, "r.toml", "yaw", {&beside, 1}).value(), expected) << "a table of one line";
  const std::string dotted = "[[axis]]\nname = \"yaw\"\n  drive.max = 7 # its most\ndrive.min = 0\n";
  EXPECT_EQ(
      with_numbers(dotted, "r.toml", "yaw", {&beside, 1}).value(),
      "[[axis]]\nname = \"yaw\"\n  drive.max = 7 # its most\n  drive.resonance_hz = -200.0\ndrive.min = 0\n");
  const std::string within = "axis = [{ name = \"yaw\", drive.max=7, drive.min = 0 }]";
  EXPECT_EQ(with_numbers(within, "r.toml", "yaw", {&beside, 1}).value(),
            "axis = [{ name = \"yaw\", drive.max=7, drive.resonance_hz = -200.0, drive.min = 0 }]");
  const AxisNumber nowhere{"axis[0].slot", 3.0};
  EXPECT_EQ(with_numbers(text, "r.toml", "", {&nowhere, 1}).error().key, "axis[0].slot");
}

TEST(RobotText, WhatIsNotThereIsNamed) {
  EXPECT_EQ(problem_of("tail", {"drive.max", 1.0}),
            "r.toml: axis: no axis is called \"tail\"; expected the name of an axis of this robot");
  EXPECT_EQ(problem_of("head", {"drive.least", 1.0}),
            "r.toml:9: axis.head.drive.least: no number stands there; expected a number");
  EXPECT_EQ(problem_of("head", {"name", 1.0}),
            "r.toml:9: axis.head.name: no number stands there; expected a number");
  EXPECT_EQ(problem_of("head", {"drive.max", 1.0}, "[[axis]]\nname = ").substr(0, 9), "r.toml:2:");
}

}  // namespace
}  // namespace interlock
