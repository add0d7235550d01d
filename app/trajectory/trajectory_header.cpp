#include "trajectory/trajectory_header.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

namespace interlock {
namespace {

using Code = TrajectoryError::Code;

/** `NAME [UNIT]`. */
struct Label {
  std::string_view name;
  std::string_view unit;
};

std::optional<Label> label_of(std::string_view column) {
  const std::size_t bracket = column.find(" [");
  if (bracket == std::string_view::npos || bracket == 0 || !column.ends_with(']')) {
    return std::nullopt;
  }
  return Label{column.substr(0, bracket), column.substr(bracket + 2, column.size() - bracket - 3)};
}

tl::unexpected<TrajectoryError> refused(Code code, const std::string& column, std::string problem,
                                        std::string expected) {
  return tl::unexpected(TrajectoryError{code, 1, column, std::move(problem), std::move(expected)});
}

std::string axis_names(const Robot& robot) {
  std::string names;
  for (const Axis& axis : robot.axes) {
    names += (names.empty() ? "" : ", ") + axis.name;
  }
  return names;
}

/** A column with what it stands for. */
struct Column {
  const Axis* axis;
  bool velocity;
};

TrajectoryResult<Column> read_column(const std::string& column, const Robot& robot) {
  const std::optional<Label> label = label_of(column);
  if (!label) {
    return refused(Code::bad_header, column, "not a column of a trajectory",
                   "NAME [UNIT], an axis with its unit, as in: yaw [rad], or yaw [rad/s] for its velocity");
  }
  const Axis* const axis = robot.find(label->name);
  if (axis == nullptr) {
    return refused(Code::unknown_axis, column, robot.name + " has no such axis",
                   "one of " + axis_names(robot));
  }
  if (!axis->motion) {
    return refused(Code::no_path, column, axis->name + " has no rates for a motion along a path",
                   "`motion` in the axis' table of the robot's file (docs/robots.md)");
  }
  const std::string unit(unit_name(axis->unit));
  if (label->unit != unit && label->unit != unit + "/s") {
    return refused(Code::wrong_unit, column, "not a unit of this axis",
                   '[' + unit + "] for its position or [" + unit + "/s] for its velocity");
  }
  return Column{axis, label->unit != unit};
}

/** Columns of an axis as they turn up, the velocity perhaps before the position. */
struct Found {
  const Axis* axis = nullptr;
  std::optional<std::size_t> position;
  std::optional<std::size_t> velocity;
};

Found& entry_of(std::vector<Found>& found, const Axis* axis) {
  const auto known = std::ranges::find(found, axis, &Found::axis);
  return known != found.end() ? *known : found.emplace_back(Found{axis, {}, {}});
}

/** Every axis with its columns, each of which has a position. */
TrajectoryResult<std::vector<AxisColumns>> complete(const std::vector<Found>& found,
                                                    std::span<const std::string> columns) {
  std::vector<AxisColumns> axes;
  for (const auto& [axis, position, velocity] : found) {
    if (!position) {
      return refused(Code::bad_header, columns[*velocity], "a velocity without its position",
                     axis->name + " [" + std::string(unit_name(axis->unit)) + "] beside it");
    }
    axes.push_back({axis, *position, velocity});
  }
  return axes;
}

}  // namespace

TrajectoryResult<std::vector<AxisColumns>> read_header(std::span<const std::string> columns,
                                                       const Robot& robot) {
  if (columns.empty() || columns.front() != time_column) {
    return refused(Code::bad_header, columns.empty() ? "" : columns.front(), "not the times",
                   std::string(time_column) + " as the first column");
  }
  if (columns.size() == 1) {
    return refused(Code::bad_header, "", "times alone", "a column for at least one of " + axis_names(robot));
  }
  std::vector<Found> found;
  for (std::size_t place = 1; place < columns.size(); ++place) {
    const TrajectoryResult<Column> column = read_column(columns[place], robot);
    if (!column) {
      return tl::unexpected(column.error());
    }
    Found& entry = entry_of(found, column->axis);
    std::optional<std::size_t>& slot = column->velocity ? entry.velocity : entry.position;
    if (slot) {
      return refused(Code::repeated_axis, columns[place], "a second column for the same",
                     "one position, and one velocity at most, for each axis");
    }
    slot = place;
  }
  return complete(found, columns);
}

}  // namespace interlock
