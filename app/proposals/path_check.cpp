#include "proposals/path_check.hpp"

#include <array>
#include <string>

#include "motion/setpoint_range.hpp"
#include "motion/trajectory_pace.hpp"
#include "proposals/separation.hpp"
#include "trajectory/synchronised_plan.hpp"

namespace interlock {
namespace {

using Checked = tl::expected<void, Refusal>;

/** Positions by slot, in counts; those of slots without a moved axis mean nothing. */
using Positions = std::array<std::int32_t, ILK_SLOTS>;

/** The positions of a trajectory were held against the ranges when it was read. */
Checked check_range(const Robot& robot, const MoveLeg& leg) {
  for (const AxisCounts& target : leg.targets) {
    const Axis& axis = *robot.at_slot(target.slot);
    if (!axis.accepts_setpoint(target.counts)) {
      return tl::make_unexpected(
          verdict_refusal(ILK_VERDICT_RANGE, axis.name + " " + counts_and_unit(axis, target.counts),
                          "a target from " + counts_and_unit(axis, axis.lowest_setpoint_counts()) + " to " +
                              counts_and_unit(axis, axis.highest_setpoint_counts())));
    }
  }
  return {};
}

RateLimits limits_of(const Axis& axis) {
  return axis.motion.value_or(MotionRates{}).in_units(axis.counts_per_unit);
}

AxisTarget target_of(const Axis& axis, std::int32_t now_counts, std::int32_t target_counts) {
  return {{axis.name, {axis.to_unit(now_counts), 0.0, 0.0}, limits_of(axis)},
          axis.to_unit(target_counts),
          {axis.to_unit(axis.lowest_setpoint_counts()), axis.to_unit(axis.highest_setpoint_counts())}};
}

tl::expected<double, Refusal> duration_of(const Robot& robot, const MoveLeg& leg, const Positions& from) {
  std::vector<AxisTarget> targets;
  for (const AxisCounts& target : leg.targets) {
    targets.push_back(target_of(*robot.at_slot(target.slot), from[target.slot], target.counts));
  }
  return plan_move(targets, leg.minimum_duration_s)
      .map([&](const SynchronisedPlan& plan) { return plan.duration_s + leg.dwell_s; })
      .map_error([](const TrajectoryError& error) {
        return Refusal{"NO_PATH", "No motion leads there: " + error.message() + ".",
                       "targets and rates with a motion between them", "Choose another target."};
      });
}

/** Where a trajectory begins, as a leg that leads there. */
MoveLeg approach_of(const Robot& robot, const TimedTrajectory& trajectory, double time_s) {
  MoveLeg approach;
  for (std::size_t place = 0; place < trajectory.axes().size(); ++place) {
    const std::uint32_t slot = trajectory.axes()[place].slot;
    const double position = trajectory.at(place, time_s).position;
    // Checked when the trajectory was read: finite, and within the range of the axis.
    approach.targets.push_back({slot, *robot.at_slot(slot)->to_counts(position)});
  }
  return approach;
}

void arrive(Positions& positions, const MoveLeg& leg) {
  for (const AxisCounts& target : leg.targets) {
    positions[target.slot] = target.counts;
  }
}

/** Looks at leg after leg; knows where the axes are then. */
class PathCheck {
 public:
  PathCheck(const Robot& robot, const ControlView& view) : robot_(robot) {
    for (const Axis& axis : robot.axes) {
      positions_[axis.slot] = view.snapshot.state.axis[axis.slot].position_counts;
    }
  }

  Checked operator()(const MoveLeg& leg) {
    return check_range(robot_, leg)
        .and_then([&] { return duration_of(robot_, leg, positions_); })
        .and_then([&](double duration_s) {
          arrive(positions_, leg);
          duration_s_ += duration_s;
          return check_separation(robot_, positions_);
        });
  }

  Checked operator()(const TimedLeg& leg) {
    const TimedTrajectory& trajectory = leg.trajectory;
    return (*this)(approach_of(robot_, trajectory, trajectory.begin_s())).and_then([&] {
      const auto stays = check_separation(robot_, positions_, trajectory);
      arrive(positions_, approach_of(robot_, trajectory, trajectory.end_s()));
      duration_s_ += pace_along(trajectory, trajectory.begin_s(), [this](std::uint32_t slot) {
                       return limits_of(*robot_.at_slot(slot));
                     }).duration_s();
      return stays;
    });
  }

  [[nodiscard]] PathPreview preview(std::uint32_t mask) const {
    PathPreview preview{{}, duration_s_};
    for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
      if (((mask >> slot) & 1u) != 0) {
        preview.ends.push_back({slot, positions_[slot]});
      }
    }
    return preview;
  }

 private:
  const Robot& robot_;
  Positions positions_{};
  double duration_s_ = 0.0;
};

}  // namespace

Checked check_axes(const Robot& robot, const ControlView& view, std::uint32_t mask) {
  for (const Axis& axis : robot.axes) {
    if (((mask >> axis.slot) & 1u) == 0) {
      continue;
    }
    const ilk_axis_t& state = view.snapshot.state.axis[axis.slot];
    if (auto able = check_axis(axis, view); !able) {
      return able;
    }
    if (state.state == ILK_AXIS_HOMING) {
      return tl::make_unexpected(verdict_refusal(ILK_VERDICT_BUSY, axis.name, "an axis that is not homing"));
    }
    if (state.homed == 0) {
      return tl::make_unexpected(Refusal{"NOT_HOMED",
                                         axis.name + " is not homed, so it cannot go to a position.",
                                         "homed axes", "Home " + axis.name + " first."});
    }
  }
  return {};
}

tl::expected<PathPreview, Refusal> check_path(const Robot& robot, const ilk_config_t& config,
                                              const ControlView& view, const PathProgram& program) {
  const std::uint32_t mask = program.mask();
  auto checked = check_system(config, view).and_then([&] { return check_axes(robot, view, mask); });
  PathCheck check(robot, view);
  for (const PathLeg& leg : program.legs) {
    checked = checked.and_then([&] { return std::visit(check, leg); });
  }
  return checked.map([&] { return check.preview(mask); });
}

}  // namespace interlock
