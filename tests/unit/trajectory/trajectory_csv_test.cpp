#include "trajectory/trajectory_csv.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <sstream>

#include "project_robots.hpp"

namespace interlock {
namespace {

using Code = TrajectoryError::Code;
using test::neuro;

TimedTrajectory trajectory_of(std::string_view text, Timing timing = Timing::as_written) {
  return read_trajectory(text, neuro(), timing).value();
}

TrajectoryError error_of(std::string_view text) {
  const auto trajectory = read_trajectory(text, neuro());
  EXPECT_FALSE(trajectory) << text;
  return trajectory ? TrajectoryError{} : trajectory.error();
}

/** A text that is refused, and the place and reason to be named. */
struct Refusal {
  std::string text;
  Code code;
  std::size_t line;
  std::string column;
};

void expect_refused(const std::vector<Refusal>& refusals) {
  for (const auto& [text, code, line, column] : refusals) {
    const TrajectoryError error = error_of(text);
    EXPECT_EQ(code_name(error.code), code_name(code)) << text;
    EXPECT_EQ(error.line, line) << text;
    EXPECT_EQ(error.column, column) << text;
    EXPECT_FALSE(error.problem.empty() || error.expected.empty()) << text;
  }
}

TEST(TrajectoryCsv, ReadsPositionsAndVelocitiesByTheNamesOfAxesInAnyOrder) {
  const TimedTrajectory trajectory =
      trajectory_of("time [s],insertion [mm/s],yaw [rad],insertion [mm]\n0,0,-0.5,10\n2,0,-0.7,14\n");
  ASSERT_EQ(trajectory.axes().size(), 2u);
  EXPECT_EQ(trajectory.axes()[0].name, "insertion");
  EXPECT_EQ(trajectory.axes()[1].slot, neuro().find("yaw")->slot);
  EXPECT_EQ(trajectory.rows(), 2u);
  EXPECT_EQ(trajectory.duration_s(), 2.0);
  EXPECT_EQ(trajectory.at(0, 1.0).position, 12.0);
  EXPECT_EQ(trajectory.axes()[0].reach, (PositionRange{10.0, 14.0}));
  EXPECT_DOUBLE_EQ(trajectory.axes()[0].top.velocity, 3.75);  // of the quintic, 15/8 of the mean
}

TEST(TrajectoryCsv, LineEndsBlanksAndAByteOrderMarkDoNotMatter) {
  const TimedTrajectory trajectory =
      trajectory_of("\xEF\xBB\xBFtime [s] , yaw [rad]\r\n 0 ,\t-5e-1\r\n1.5,-0.6");
  EXPECT_EQ(trajectory.rows(), 2u);
  EXPECT_EQ(trajectory.at(0, 1.5).position, -0.6);
}

TEST(TrajectoryCsv, NamesTheColumnOfABadHeader) {
  const std::string row = "\n0,0,0\n";
  expect_refused({
      {"", Code::empty, 1, "time [s]"},
      {"yaw [rad],time [s]" + row, Code::bad_header, 1, "yaw [rad]"},
      {"time [ms],yaw [rad]" + row, Code::bad_header, 1, "time [ms]"},
      {"time [s]\n0\n", Code::bad_header, 1, ""},
      {"time [s],yaw" + row, Code::bad_header, 1, "yaw"},
      {"time [s]," + row, Code::bad_header, 1, ""},
      {"time [s],yaw [rad/s]" + row, Code::bad_header, 1, "yaw [rad/s]"},
      {"time [s],elbow [rad]" + row, Code::unknown_axis, 1, "elbow [rad]"},
      {"time [s],time [s]" + row, Code::unknown_axis, 1, "time [s]"},
      {"time [s],yaw [rad],yaw [rad]" + row, Code::repeated_axis, 1, "yaw [rad]"},
      {"time [s],yaw [deg]" + row, Code::wrong_unit, 1, "yaw [deg]"},
      {"time [s],insertion [rad]" + row, Code::wrong_unit, 1, "insertion [rad]"},
      {"time [s],yaw [mm/s]" + row, Code::wrong_unit, 1, "yaw [mm/s]"},
      {"time [s],\x01\xFF [rad]" + row, Code::unknown_axis, 1, "?? [rad]"},
      {std::string(100, ',') + row, Code::wrong_columns, 1, ""},
  });
}

TEST(TrajectoryCsv, NamesLineAndColumnOfABadRow) {
  const std::string good = "time [s],yaw [rad],insertion [mm]\n0,-0.5,10\n1,-0.5,10\n";
  expect_refused({
      {"time [s],yaw [rad]\n", Code::empty, 2, "time [s]"},
      {good + "2,-0.5\n", Code::wrong_columns, 4, "insertion [mm]"},
      {good + "2,-0.5,10,\n", Code::wrong_columns, 4, "column 4"},
      {good + "\n", Code::wrong_columns, 4, "yaw [rad]"},
      {good + "2,x,10\n", Code::not_a_number, 4, "yaw [rad]"},
      {good + "2,-0.5,\n", Code::not_a_number, 4, "insertion [mm]"},
      {good + "2,-0.5,10 mm\n", Code::not_a_number, 4, "insertion [mm]"},
      {good + "+2,-0.5,10\n", Code::not_a_number, 4, "time [s]"},
      {good + "2,nan,10\n", Code::not_finite, 4, "yaw [rad]"},
      {good + "2,-0.5,-inf\n", Code::not_finite, 4, "insertion [mm]"},
      {good + "inf,-0.5,10\n", Code::not_finite, 4, "time [s]"},
      {good + "2,1e999,10\n", Code::out_of_range, 4, "yaw [rad]"},
      {good + "1,-0.5,10\n", Code::unsorted_times, 4, "time [s]"},
      {good + "0.5,-0.5,10\n", Code::unsorted_times, 4, "time [s]"},
      {good + "1.0000001,-0.5,10\n", Code::unsorted_times, 4, "time [s]"},
      {good + "1.0000009,-0.5,10\n", Code::unsorted_times, 4, "time [s]"},
      {good + "1e6,-0.5,10\n", Code::out_of_range, 4, "time [s]"},
      {"time [s],yaw [rad]\n-1,0\n", Code::out_of_range, 2, "time [s]"},
      {good + "2,0.5,10\n", Code::out_of_range, 4, "yaw [rad]"},
      {good + "2,-1e300,10\n", Code::out_of_range, 4, "yaw [rad]"},
  });
}

TEST(TrajectoryCsv, TimesAMicrosecondApartAreNoneThatIsRepeated) {
  std::string text = "time [s],yaw [rad]\n";
  for (int n = 0; n < 30; ++n) {
    text += "0.0000" + std::to_string(10 + n) + ",-0.5\n";
  }
  EXPECT_EQ(trajectory_of(text).rows(), 30u);
}

TEST(TrajectoryCsv, ATrajectoryThatFitsKeepsItsTimesToTheLastBit) {
  const std::string rows = "0.1,-0.5\n0.3,-0.5\n0.7,-0.5\n1.1,-0.5\n";
  for (const Timing timing : {Timing::as_written, Timing::slowed_to_fit}) {
    const TimedTrajectory trajectory = trajectory_of("time [s],yaw [rad]\n" + rows, timing);
    EXPECT_EQ(trajectory.begin_s(), 0.1);
    EXPECT_EQ(trajectory.end_s(), 1.1);
    EXPECT_EQ(trajectory.slowed_by(), 1.0);
  }
}

TEST(TrajectoryCsv, SaysWhatWasExpected) {
  EXPECT_EQ(error_of("time [s],yaw [deg]\n").message(),
            "line 1, yaw [deg]: not a unit of this axis; expected [rad] for its position or [rad/s] for its "
            "velocity");
  EXPECT_EQ(error_of("time [s],insertion [mm]\n0,10\n1,-4\n").message(),
            "line 3, insertion [mm]: -4 is out of range; expected 0.254022015241 to 34.6740050804 mm, what "
            "the kernel accepts of it");
}

TEST(TrajectoryCsv, PositionsEndWhereTheKernelsSetpointsEnd) {
  const Axis& axis = *neuro().find("insertion");
  for (const double place : {-0.49, 0.49}) {
    const double lowest = (axis.lowest_setpoint_counts() - place) / axis.counts_per_unit;
    const double highest = (axis.highest_setpoint_counts() + place) / axis.counts_per_unit;
    std::ostringstream text;
    text.precision(17);
    text << "time [s],insertion [mm]\n0," << lowest << "\n20," << highest << '\n';
    EXPECT_TRUE(read_trajectory(text.str(), neuro())) << text.str();
  }
  const double beyond = (axis.highest_setpoint_counts() + 0.51) / axis.counts_per_unit;
  EXPECT_EQ(error_of("time [s],insertion [mm]\n0," + std::to_string(beyond)).code, Code::out_of_range);
}

TEST(TrajectoryCsv, AWayThatLeavesTheLimitsBetweenItsRowsIsRefused) {
  const std::string header = "time [s],insertion [mm],insertion [mm/s]\n";
  EXPECT_EQ(trajectory_of(header + "0,20,10\n1,20,-10\n").axes()[0].reach.highest, 22.5);
  const TrajectoryError error = error_of(header + "0,34,10\n1,34,-10\n");
  EXPECT_EQ(error.code, Code::out_of_range);
  EXPECT_EQ(error.line, 3u);
  EXPECT_THAT(error.problem, testing::HasSubstr("36.5 on the way"));
}

TEST(TrajectoryCsv, MoreRowsThanTheCeilingAreRefusedUnread) {
  std::string text = "time [s],yaw [rad]\n";
  for (std::size_t row = 0; row < most_trajectory_rows; ++row) {
    text += std::to_string(row) + ",-0.5\n";
  }
  EXPECT_EQ(trajectory_of(text).rows(), most_trajectory_rows);
  text += "not read\n";
  EXPECT_EQ(error_of(text).code, Code::too_large);
  EXPECT_EQ(error_of(text).line, most_trajectory_rows + 2);
  EXPECT_EQ(error_of(std::string(most_trajectory_bytes + 1, ' ')).code, Code::too_large);
}

TEST(TrajectoryBuilder, KeepsToTheCeilingByItself) {
  TrajectoryBuilder builder = TrajectoryBuilder::create({"time [s]", "yaw [rad]"}, neuro()).value();
  for (std::size_t row = 0; row < most_trajectory_rows; ++row) {
    ASSERT_TRUE(builder.add(std::array{static_cast<double>(row), -0.5}));
  }
  EXPECT_EQ(builder.add(std::array{99999.5, -0.5}).error().code, Code::too_large);
}

TEST(TrajectoryBuilder, ARefusedRowLeavesTheTrajectoryAsItWas) {
  TrajectoryBuilder builder = TrajectoryBuilder::create({"time [s]", "yaw [rad]"}, neuro()).value();
  EXPECT_TRUE(builder.add(std::array{0.0, -0.5}));
  EXPECT_FALSE(builder.add(std::array{1.0, -9.0}));
  EXPECT_FALSE(builder.add(std::array{1.0}));
  EXPECT_TRUE(builder.add(std::array{1.0, -0.6}));
  const auto trajectory = std::move(builder).finish();
  ASSERT_TRUE(trajectory);
  EXPECT_EQ(trajectory->rows(), 2u);
  EXPECT_EQ(trajectory->axes()[0].reach, (PositionRange{-0.6, -0.5}));
}

TEST(TimedTrajectory, StandsAtItsEndsBeforeAndAfter) {
  const TimedTrajectory trajectory =
      trajectory_of("time [s],yaw [rad],yaw [rad/s]\n1,-0.5,0.1\n2,-0.4,0.1\n");
  EXPECT_EQ(trajectory.at(0, 0.5), (MotionState{-0.5, 0.0, 0.0}));
  EXPECT_EQ(trajectory.at(0, std::nan("")), (MotionState{-0.5, 0.0, 0.0}));
  EXPECT_DOUBLE_EQ(trajectory.at(0, 1.0).velocity, 0.1);
  EXPECT_EQ(trajectory.at(0, 2.0), (MotionState{-0.4, 0.0, 0.0}));
  EXPECT_EQ(trajectory.at(0, 1e9), (MotionState{-0.4, 0.0, 0.0}));
}

}  // namespace
}  // namespace interlock
