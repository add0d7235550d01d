#include "proposals/line_program.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "trajectory/trajectory_builder.hpp"

namespace interlock {
namespace {

using Eigen::Vector3d;
template <typename Value>
using Made = tl::expected<Value, Refusal>;

/** Where a robot has no entry point, its direction is taken from a point so far behind. */
constexpr double lever_mm = 100.0;
/** Of the derivative by the way. */
constexpr double difference_mm = 1e-3;
constexpr std::size_t fewest_rows = 9;
constexpr std::size_t most_rows = 1025;
constexpr int line_samples = 8;
/** An axis that moves by less than this share of a count stays where it is. */
constexpr double least_counts = 1e-3;
constexpr double half_count = 0.5;

std::string mm(double value) { return number_text(std::round(value * 1000.0) / 1000.0) + " mm"; }

/** What is known of the robot at each mm of a line. */
class Line {
 public:
  /** `entry` lies on the axis of `start`. */
  Line(const Robot& robot, const RobotKinematics& kinematics, const Pose& start, const Vector3d& entry,
       const LineRequest& request, double rotation_rad)
      : robot_(robot),
        kinematics_(kinematics),
        start_mm_(start.translation()),
        along_((request.end_mm - start.translation()).normalized()),
        length_mm_((request.end_mm - start.translation()).norm()),
        moves_entry_(!request.entry_mm),
        rotation_rad_(rotation_rad),
        entry_mm_(entry) {}

  [[nodiscard]] double length_mm() const { return length_mm_; }

  [[nodiscard]] Made<AxisPositions> at(double way_mm) const {
    const Vector3d target = start_mm_ + way_mm * along_;
    auto found =
        kinematics_.positions_for(entry_mm_ + (moves_entry_ ? way_mm : 0.0) * along_, target, rotation_rad_);
    if (!found) {
      return refused_at(way_mm, std::string(code_name(found.error().code)), found.error().message());
    }
    return *std::move(found);
  }

  /** As `at`, away from singular poses and within what the kernel accepts. */
  [[nodiscard]] Made<AxisPositions> safe_at(double way_mm) const {
    return at(way_mm).and_then([&](AxisPositions positions) -> Made<AxisPositions> {
      if (const auto jacobian = kinematics_.jacobian(positions); !jacobian) {
        return refused_at(way_mm, std::string(code_name(jacobian.error().code)), jacobian.error().message());
      }
      for (std::size_t place = 0; place < positions.size(); ++place) {
        const Axis& axis = robot_.axes[place];
        const double low = axis.to_unit(axis.lowest_setpoint_counts());
        const double high = axis.to_unit(axis.highest_setpoint_counts());
        // As far beyond as an axis rests that was sent to its end.
        const double slack = (axis.deadband_counts + half_count) / axis.counts_per_unit;
        if (!axis.role.empty() && !(positions[place] >= low - slack && positions[place] <= high + slack)) {
          const std::string unit(unit_name(axis.unit));
          return refused_at(way_mm, "RANGE",
                            axis.title + " would be at " + number_text(positions[place]) + ' ' + unit +
                                "; it goes from " + number_text(low) + " to " + number_text(high) + ' ' +
                                unit + ".");
        }
        positions[place] = axis.role.empty() ? positions[place] : std::clamp(positions[place], low, high);
      }
      return positions;
    });
  }

  /** By mm of the way. */
  [[nodiscard]] Made<AxisPositions> slope_at(double way_mm) const {
    const double before = std::max(0.0, way_mm - difference_mm);
    const double after = std::min(length_mm_, way_mm + difference_mm);
    return at(before).and_then([&](const AxisPositions& one) {
      return at(after).map([&](AxisPositions other) {
        for (std::size_t place = 0; place < one.size(); ++place) {
          other[place] = (other[place] - one[place]) / (after - before);
        }
        return other;
      });
    });
  }

  /** Of the treatment point from the line, and of the probe's axis from the entry. */
  [[nodiscard]] Eigen::Matrix<double, 6, 1> deviation_of(const Pose& pose) const {
    const Vector3d from_start = pose.translation() - start_mm_;
    const double way_mm = from_start.dot(along_);
    const Vector3d entry = entry_mm_ + (moves_entry_ ? way_mm : 0.0) * along_ - pose.translation();
    const Vector3d ahead = pose.linear().col(2);
    return (Eigen::Matrix<double, 6, 1>() << from_start - way_mm * along_, entry - entry.dot(ahead) * ahead)
        .finished();
  }

  [[nodiscard]] tl::unexpected<Refusal> refused_at(double way_mm, std::string code,
                                                   const std::string& what) const {
    return tl::make_unexpected(
        Refusal{std::move(code), "At " + mm(way_mm) + " of the line's " + mm(length_mm_) + ": " + what,
                "a line within reach of all axes", "Ask for a shorter line, or for another one."});
  }

 private:
  const Robot& robot_;
  const RobotKinematics& kinematics_;
  Vector3d start_mm_;
  Vector3d along_;
  double length_mm_;
  bool moves_entry_;
  double rotation_rad_;
  Vector3d entry_mm_;
};

double larger_part(const Eigen::Matrix<double, 6, 1>& deviation) {
  return std::max(deviation.head<3>().norm(), deviation.tail<3>().norm());
}

/** Bound of the deviation over all of the trajectory; nothing where a position between rows has no pose. */
std::optional<double> deviation_bound(const Robot& robot, const RobotKinematics& kinematics, const Line& line,
                                      const AxisPositions& from, const TimedTrajectory& trajectory) {
  const auto count = static_cast<int>(trajectory.rows() - 1) * line_samples;
  AxisPositions positions = from;
  std::vector<Eigen::Matrix<double, 6, 1>> deviations;
  double largest = 0.0;
  double bent = 0.0;
  for (int sample = 0; sample <= count; ++sample) {
    const double time_s = trajectory.begin_s() + trajectory.duration_s() * sample / count;
    for (std::size_t axis = 0; axis < trajectory.axes().size(); ++axis) {
      const auto place =
          static_cast<std::size_t>(robot.at_slot(trajectory.axes()[axis].slot) - robot.axes.data());
      positions[place] = trajectory.at(axis, time_s).position;
    }
    const auto pose = kinematics.zframe_from_treatment(positions);
    if (!pose) {
      return std::nullopt;
    }
    deviations.push_back(line.deviation_of(*pose));
    largest = std::max(largest, larger_part(deviations.back()));
    if (const std::size_t size = deviations.size(); size > 2) {
      bent = std::max(bent,
                      larger_part(deviations[size - 1] - 2.0 * deviations[size - 2] + deviations[size - 3]));
    }
  }
  return largest + bent / 4.0;
}

Refusal unreadable(const TrajectoryError& error) {
  return {std::string(code_name(error.code)), "No motion follows the line: " + error.message() + ".",
          "a line that every axis can follow", "Ask for another line."};
}

/** The line by so many rows, evenly in the time of the course. */
Made<TimedTrajectory> trajectory_of(const Robot& robot, const Line& line, std::size_t rows, double speed_mm_s,
                                    const AxisPositions& from) {
  constexpr double fastest = 1.875;  // of the course, by its mean speed
  const double duration_s = fastest * line.length_mm() / speed_mm_s;
  std::vector<double> times_s;
  std::vector<AxisPositions> positions;
  std::vector<AxisPositions> velocities;
  for (std::size_t row = 0; row < rows; ++row) {
    const double tau = static_cast<double>(row) / static_cast<double>(rows - 1);
    const double way_mm = line.length_mm() * tau * tau * tau * (10.0 + tau * (6.0 * tau - 15.0));
    const double speed = 30.0 * line.length_mm() / duration_s * tau * tau * (1.0 - tau) * (1.0 - tau);
    auto position = line.safe_at(way_mm);
    auto slope = position.and_then([&](const AxisPositions&) { return line.slope_at(way_mm); });
    if (!slope) {
      return tl::make_unexpected(slope.error());
    }
    for (double& each : *slope) {
      each *= speed;
    }
    times_s.push_back(tau * duration_s);
    positions.push_back(*std::move(position));
    velocities.push_back(*std::move(slope));
  }
  std::vector<std::string> columns{"time [s]"};
  std::vector<std::size_t> moved;
  for (std::size_t place = 0; place < from.size(); ++place) {
    const Axis& axis = robot.axes[place];
    const bool moves = std::ranges::any_of(positions, [&](const AxisPositions& each) {
      return std::abs(each[place] - from[place]) * axis.counts_per_unit > least_counts;
    });
    if (moves && !axis.role.empty()) {
      const std::string unit(unit_name(axis.unit));
      moved.push_back(place);
      columns.push_back(axis.name + " [" + unit + ']');
      columns.push_back(axis.name + " [" + unit + "/s]");
    }
  }
  auto builder = TrajectoryBuilder::create(std::move(columns), robot, Timing::slowed_to_fit);
  if (!builder) {
    return tl::make_unexpected(unreadable(builder.error()));
  }
  for (std::size_t row = 0; row < rows; ++row) {
    std::vector<double> numbers{times_s[row]};
    for (const std::size_t place : moved) {
      numbers.push_back(positions[row][place]);
      numbers.push_back(velocities[row][place]);
    }
    if (const auto added = builder->add(numbers); !added) {
      return tl::make_unexpected(unreadable(added.error()));
    }
  }
  return std::move(*builder).finish().map_error(unreadable);
}

/** How far the probe is turned about its axis, by the axis that turns it. */
double rotation_of(const Robot& robot, const AxisPositions& positions) {
  for (const char* const role : {"probe_rotation", "rotation"}) {
    if (const Axis* const axis = robot.with_role(role)) {
      return positions[static_cast<std::size_t>(axis - robot.axes.data())];
    }
  }
  return 0.0;
}

/** A probe that is inserted is not moved across its axis with its direction kept. */
Made<void> check_not_inserted(const Robot& robot, const AxisPositions& from, const Pose& start,
                              const LineRequest& request) {
  const Axis* const insertion = robot.with_role("insertion");
  const Vector3d way = request.end_mm - start.translation();
  const Vector3d ahead = start.linear().col(2);
  const double across_mm = (way - way.dot(ahead) * ahead).norm();
  if (insertion == nullptr || request.entry_mm || across_mm <= request.deviation_mm) {
    return {};
  }
  const double position = from[static_cast<std::size_t>(insertion - robot.axes.data())];
  const double out = insertion->to_unit(insertion->lowest_setpoint_counts());
  const double slack = (insertion->deadband_counts + half_count) / insertion->counts_per_unit;
  if (position <= out + slack) {
    return {};
  }
  return tl::make_unexpected(
      Refusal{"INSERTED",
              insertion->title + " is at " + mm(position) + ", and the line leads the probe " +
                  mm(across_mm) + " across its axis.",
              "a probe that is out as far as it goes", "Retract the probe, or keep its entry point."});
}

}  // namespace

std::optional<Vector3d> entry_at(const RobotKinematics& kinematics, const AxisPositions& positions) {
  const auto pose = kinematics.zframe_from_treatment(positions);
  const auto depth = kinematics.depth_mm(positions);
  return pose && depth ? std::optional<Vector3d>(pose->translation() - *depth * pose->linear().col(2))
                       : std::nullopt;
}

Made<PathProgram> line_program(const Robot& robot, const RobotKinematics& kinematics,
                               const AxisPositions& from, const LineRequest& request) {
  const auto start = kinematics.zframe_from_treatment(from);
  if (!start) {
    return tl::make_unexpected(Refusal{std::string(code_name(start.error().code)), start.error().message(),
                                       "a robot whose pose is known", "Move the axes apart one by one."});
  }
  const double length_mm = (request.end_mm - start->translation()).norm();
  if (!(length_mm >= shortest_line_mm && length_mm <= longest_line_mm)) {
    return tl::make_unexpected(Refusal{"OUT_OF_RANGE", "The line is " + mm(length_mm) + " long.",
                                       "a line of 0.1 to 1000 mm", "Ask for another one."});
  }
  const Vector3d ahead = start->linear().col(2);
  double behind_mm = kinematics.depth_mm(from).value_or(lever_mm);
  if (request.entry_mm) {
    const Vector3d from_entry = start->translation() - *request.entry_mm;
    behind_mm = from_entry.dot(ahead);
    const double miss_mm = (from_entry - behind_mm * ahead).norm();
    if (miss_mm > request.deviation_mm || behind_mm < shortest_line_mm) {
      return tl::make_unexpected(Refusal{
          "OFF_AXIS",
          "The probe's axis passes " + mm(miss_mm) + " beside the entry point, which is " + mm(behind_mm) +
              " behind the treatment point.",
          "an entry point on the axis, behind the treatment point", "Line the probe up with it first."});
    }
  }
  if (const auto out = check_not_inserted(robot, from, *start, request); !out) {
    return tl::make_unexpected(out.error());
  }
  const Line line(robot, kinematics, *start, start->translation() - behind_mm * ahead, request,
                  rotation_of(robot, from));
  const auto first = line.at(0.0);
  if (!first) {
    return tl::make_unexpected(first.error());
  }
  for (std::size_t place = 0; place < from.size(); ++place) {
    const Axis& axis = robot.axes[place];
    if (!axis.role.empty() && std::abs((*first)[place] - from[place]) * axis.counts_per_unit > half_count) {
      return line.refused_at(0.0, "NO_LINE",
                             "the kinematics reach the same pose with " + axis.title + " at " +
                                 number_text((*first)[place]) + ' ' + std::string(unit_name(axis.unit)) +
                                 " instead of " + number_text(from[place]) + '.');
    }
  }
  double bound_mm = 0.0;
  for (std::size_t rows = fewest_rows; rows <= most_rows; rows = 2 * rows - 1) {
    auto trajectory = trajectory_of(robot, line, rows, request.speed_mm_s, from);
    if (!trajectory) {
      return tl::make_unexpected(trajectory.error());
    }
    const auto bound = deviation_bound(robot, kinematics, line, from, *trajectory);
    if (bound && *bound <= request.deviation_mm) {
      return PathProgram{{TimedLeg{*std::move(trajectory)}},
                         LineFigures{length_mm, request.deviation_mm, *bound, !request.entry_mm}};
    }
    bound_mm = bound.value_or(length_mm);
  }
  return tl::make_unexpected(Refusal{
      "NO_LINE",
      "With " + std::to_string(most_rows) + " rows the axes still leave the line by " + mm(bound_mm) + ".",
      "at most " + mm(request.deviation_mm),
      "Allow a larger deviation, or ask for a line farther from where a joint turns fast."});
}

}  // namespace interlock
