#include "calibration/pose_table.hpp"

#include <gmock/gmock.h>

#include "robot_on_tracker.hpp"

namespace interlock {
namespace {

using testing::HasSubstr;

constexpr const char* header =
    "across [mm],up [mm],yaw [rad],pitch [rad],insertion [mm],tool_x [mm],tool_y [mm],tool_z [mm]";

const Robot& gantry() {
  static const test::RobotText file(INTERLOCK_TEST_ROBOTS "/gantry.toml");
  return file.robot;
}

auto read(const std::string& text) { return read_poses(text, "poses.csv", gantry()); }

TEST(PoseTable, ColumnsInAnyOrderWithBlanksAndEitherEndOfLineAreRead) {
  const auto poses = read(
      "\xEF\xBB\xBFtool_z [mm], tool_y [mm],tool_x [mm],insertion [mm],pitch [rad],yaw [rad],up [mm],across "
      "[mm],"
      "direction_x,direction_y,direction_z,sd [mm],sd [rad]\r\n"
      "3,2,1, 30 ,0.1,-0.2,20,10,0,0.6,0.8,0.1,0.01\r\n"
      "6,5,4,31,0.1,-0.2,20,10,0,0,1.0005,0.1,0.01");
  ASSERT_TRUE(poses) << poses.error().message();
  ASSERT_EQ(poses->size(), 2U);
  EXPECT_EQ(poses->front().line, 2U);
  EXPECT_EQ(poses->front().positions, (std::vector{10.0, 20.0, -0.2, 0.1, 30.0}));
  EXPECT_EQ(poses->front().point_mm, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(*poses->front().direction, Eigen::Vector3d(0.0, 0.6, 0.8));
  EXPECT_EQ(poses->front().sd_mm, 0.1);
  EXPECT_EQ(poses->back().direction->norm(), 1.0);
  EXPECT_FALSE(read(std::string(header) + "\n1,1,0,0,1,1,1,1")->front().direction);
}

struct BadTable {
  const char* name;
  std::string text;
  const char* message;
};

void PrintTo(const BadTable& table, std::ostream* stream) { *stream << table.name; }

class PoseTableThatIsBad : public testing::TestWithParam<BadTable> {};

std::string with(const std::string& row) { return std::string(header) + "\n1,1,0,0,1,1,1,1\n" + row + "\n"; }

INSTANTIATE_TEST_SUITE_P(
    Tables, PoseTableThatIsBad,
    testing::Values(
        BadTable{"Empty", "",
                 "0 lines are given; expected a header and 1 to 10000 poses: across [mm], up [mm]"},
        BadTable{"OnlyAHeader", header, "1 lines are given"},
        BadTable{"MissingAxis", "up [mm],tool_x [mm],tool_y [mm],tool_z [mm]\n1,1,1,1",
                 "poses.csv:1: across [mm]: the column is missing"},
        BadTable{"WrongUnit", "across [cm],up [mm]\n1,1", "poses.csv:1: across [cm]: no such column"},
        BadTable{"Repeated", "up [mm],up [mm]\n1,1", "poses.csv:1: up [mm]: a second column of that name"},
        BadTable{"HalfADirection", std::string(header) + ",direction_x\n1,1,0,0,1,1,1,1,1",
                 "poses.csv:1: direction_x: a direction has three numbers"},
        BadTable{"TooFewFields", with("1,1"), "poses.csv:3: 2 fields; expected 8 as in the header"},
        BadTable{"NoNumber", with("1,1,0,far,1,1,1,1"),
                 "poses.csv:3: pitch [rad]: \"far\" is given; expected a finite number"},
        BadTable{"Empty_field", with("1,1,0,,1,1,1,1"), "poses.csv:3: pitch [rad]: \"\" is given"},
        BadTable{"NotFinite", with("1,1,0,0,1,nan,1,1"), "poses.csv:3: tool_x [mm]: \"nan\" is given"},
        BadTable{"BeyondTheAxis", with("1,1,0.7,0,1,1,1,1"),
                 "poses.csv:3: yaw: 0.7 is beyond the soft limits; expected -0.6 to 0.6 rad"},
        BadTable{"FarAway", with("1,1,0,0,1,1,1,1e9"), "farther than 100 m"},
        BadTable{"NoUnitVector",
                 std::string(header) + ",direction_x,direction_y,direction_z\n1,1,0,0,1,1,1,1,0,0,2",
                 "poses.csv:2: direction_x: the direction is of length 2"},
        BadTable{"NoDeviation", std::string(header) + ",sd [mm]\n1,1,0,0,1,1,1,1,0",
                 "poses.csv:2: sd: a standard deviation of 0 mm is not from 0.0001 to 20 mm"},
        BadTable{"TinyDeviation", std::string(header) + ",sd [rad]\n1,1,0,0,1,1,1,1,1e-9",
                 "poses.csv:2: sd: a standard deviation of 1e-09 rad is not from"},
        BadTable{"SameRow", with("2,1,0,0,1,1,1,1\n 1,1,0, 0,1,1,1,1"),
                 "poses.csv:4: the row is that of line 2 again"}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST_P(PoseTableThatIsBad, IsRefusedWithLineColumnAndWhatWasExpected) {
  const auto poses = read(GetParam().text);
  ASSERT_FALSE(poses);
  EXPECT_THAT(poses.error().message(), HasSubstr(GetParam().message));
}

}  // namespace
}  // namespace interlock
