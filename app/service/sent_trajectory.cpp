#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "service/alignment_view.hpp"
#include "service/drafts.hpp"
#include "service/loaded_trajectory.hpp"
#include "trajectory/trajectory_builder.hpp"

namespace interlock {
namespace {

constexpr const char* time_name = "time [s]";
constexpr const char* pose_name = "pose";

std::string position_column(const Axis& axis) {
  return axis.name + " [" + std::string(unit_name(axis.unit)) + "]";
}

std::string velocity_column(const Axis& axis) {
  return axis.name + " [" + std::string(unit_name(axis.unit)) + "/s]";
}

/** Row 0 and no column: all of it. */
Problem bad_row(std::string code, std::size_t row, const std::string& column, const std::string& what,
                std::string expected) {
  std::string place = row == 0 ? "The trajectory" : "Row " + std::to_string(row);
  place += column.empty() ? "" : ", " + column;
  return {.status = Status::unprocessable_entity,
          .code = std::move(code),
          .detail = place + ": " + what + ".",
          .field = column,
          .expected = std::move(expected),
          .next_step = "Nothing was loaded."};
}

/** The builder counts lines of a text, of which the header is the first. */
Problem bad_row(const TrajectoryError& error) {
  return bad_row(std::string(code_name(error.code)), error.line == 0 ? 0 : error.line - 1, error.column,
                 error.problem, error.expected);
}

std::vector<std::string> columns_of(const Robot& robot, bool with_velocities) {
  std::vector<std::string> columns{time_name};
  for (const Axis& axis : robot.axes) {
    columns.push_back(position_column(axis));
    if (with_velocities) {
      columns.push_back(velocity_column(axis));
    }
  }
  return columns;
}

/** Every row of an array has as many columns. */
Problem wrong_count(const std::vector<std::string>& columns, std::size_t count) {
  const bool missing = count < columns.size();
  return bad_row(
      "WRONG_COLUMNS", 1, missing ? columns[count] : "column " + std::to_string(columns.size() + 1),
      (missing ? "missing, as there are " : "one too many, as there are ") + std::to_string(count) +
          " columns",
      std::to_string(columns.size()) + " (time and positions) or " + std::to_string(2 * columns.size() - 1) +
          " (with velocities), axes in the order of the robot's file");
}

/** Adds a row, or says what is wrong with it. */
tl::expected<void, Problem> add(TrajectoryBuilder& builder, std::span<const double> row) {
  return builder.add(row).map_error([](const TrajectoryError& error) { return bad_row(error); });
}

tl::expected<TimedTrajectory, Problem> finished(TrajectoryBuilder builder) {
  return std::move(builder).finish().map_error([](const TrajectoryError& error) { return bad_row(error); });
}

/** Time and setpoints of a pose. */
tl::expected<std::vector<double>, Problem> row_of(const Robot& robot, Targeting targeting,
                                                  const igtl::TimedPose& pose, std::size_t number) {
  if (!igtl::is_rigid(pose.scanner_from_treatment)) {
    return fail(bad_row("INVALID", number, pose_name, "it is no rigid motion",
                        "R^T R = 1 within 0.0001, determinant 1"));
  }
  aim_at(targeting, pose.scanner_from_treatment);
  const auto alignment = alignment_with(robot, targeting);
  if (!alignment) {
    return fail(bad_row(alignment.error().code, number, pose_name, alignment.error().detail,
                        "a pose that the robot can reach"));
  }
  if (const auto miss = out_of_reach(robot, *alignment)) {
    return fail(bad_row(miss->code, number, pose_name, miss->detail, miss->expected));
  }
  std::vector<double> row{pose.time_s};
  for (const AxisSetpoint& setpoint : alignment->setpoints) {
    row.push_back(robot.at_slot(setpoint.slot)->to_unit(setpoint.counts));
  }
  return row;
}

}  // namespace

tl::expected<TimedTrajectory, Problem> trajectory_of(const Robot& robot, const igtl::LoadRows& rows) {
  std::vector<std::string> columns = columns_of(robot, rows.columns > 1 + robot.axes.size());
  if (rows.columns != columns.size()) {
    return fail(wrong_count(columns_of(robot, false), rows.columns));
  }
  auto builder = TrajectoryBuilder::create(std::move(columns), robot);
  if (!builder) {
    return fail(bad_row(builder.error()));
  }
  for (std::size_t at = 0; at < rows.values.size(); at += rows.columns) {
    if (const auto added = add(*builder, {&rows.values[at], rows.columns}); !added) {
      return fail(added.error());
    }
  }
  return finished(std::move(*builder));
}

tl::expected<TimedTrajectory, Problem> trajectory_of(const Robot& robot, const Targeting& targeting,
                                                     const igtl::LoadPoses& poses) {
  std::vector<std::string> columns{time_name};
  for (const Axis& axis : robot.axes) {
    if (!axis.role.empty()) {
      columns.push_back(position_column(axis));
    }
  }
  auto builder = TrajectoryBuilder::create(std::move(columns), robot);
  if (!builder) {
    return fail(bad_row(builder.error()));
  }
  for (std::size_t i = 0; i < poses.poses.size(); ++i) {
    const auto added = row_of(robot, targeting, poses.poses[i], i + 1).and_then([&](const auto& row) {
      return add(*builder, row);
    });
    if (!added) {
      return fail(added.error());
    }
  }
  return finished(std::move(*builder));
}

}  // namespace interlock
