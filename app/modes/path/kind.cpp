#include <array>
#include <nlohmann/json.hpp>
#include <string>

#include "modes/path/mode.hpp"
#include "motion/setpoint_range.hpp"
#include "motion/time_scaling.hpp"
#include "proposals/checks.hpp"
#include "proposals/motion_kind.hpp"
#include "trajectory/synchronised_plan.hpp"

namespace interlock {
namespace {

using nlohmann::json;

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
    if (const Axis& axis = *robot.at_slot(target.slot); !axis.motion) {
      return tl::make_unexpected(
          Refusal{"NO_PATH", axis.name + " has no rates for a motion along a path in the robot's file.",
                  "`motion` in the axis' table of the file (docs/robots.md)",
                  "Add it and start anew, or move the axis by itself."});
    }
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

/** The move with which a leg begins: all of it, or the way to where its trajectory begins. */
MoveLeg first_move(const Robot& robot, const PathLeg& leg) {
  const auto* timed = std::get_if<TimedLeg>(&leg);
  return timed == nullptr ? std::get<MoveLeg>(leg)
                          : approach_of(robot, timed->trajectory, timed->trajectory.begin_s());
}

void arrive(Positions& positions, const MoveLeg& leg) {
  for (const AxisCounts& target : leg.targets) {
    positions[target.slot] = target.counts;
  }
}

std::uint32_t mask_of(const MoveLeg& leg) {
  std::uint32_t mask = 0;
  for (const AxisCounts& target : leg.targets) {
    mask |= 1u << target.slot;
  }
  return mask;
}

/** Looks at leg after leg; knows where the axes are then. */
class PathCheck {
 public:
  PathCheck(const Robot& robot, const ControlView& view, const PathProgram& program)
      : robot_(robot), view_(view), program_(program) {
    for (const Axis& axis : robot.axes) {
      start_[axis.slot] = view.snapshot.state.axis[axis.slot].position_counts;
    }
  }

  [[nodiscard]] Checked ranges() const {
    return each_leg([&](const MoveLeg& move, const TimedTrajectory*, const Positions&) {
      return check_range(robot_, move);
    });
  }

  [[nodiscard]] Checked separation() const {
    return each_leg([&](const MoveLeg& move, const TimedTrajectory* trajectory, Positions positions) {
      arrive(positions, move);
      AxisStates axes = states_of(view_);
      for (const Axis& axis : robot_.axes) {
        axes[axis.slot].position_counts = positions[axis.slot];
      }
      return check_separation(robot_, axes, mask_of(move)).and_then([&] {
        return trajectory == nullptr ? Checked() : check_separation(robot_, axes, *trajectory);
      });
    });
  }

  /** Sums up the duration besides. */
  [[nodiscard]] Checked rates() {
    return each_leg([&](const MoveLeg& move, const TimedTrajectory* trajectory, const Positions& positions) {
      return duration_of(robot_, move, positions).map([&](double duration_s) {
        duration_s_ += duration_s + (trajectory == nullptr ? 0.0 : paced_s(*trajectory));
      });
    });
  }

  /** Once the checks have passed. */
  [[nodiscard]] PathPreview preview() const {
    PathPreview preview{{}, duration_s_};
    const Positions end = end_of_legs();
    for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
      if (((program_.mask() >> slot) & 1u) != 0) {
        preview.ends.push_back({slot, end[slot]});
      }
    }
    return preview;
  }

 private:
  /** Until one leg fails: `look(move, trajectory or null, positions at its start)`. */
  template <typename Look>
  [[nodiscard]] Checked each_leg(const Look& look) const {
    Positions positions = start_;
    for (const PathLeg& leg : program_.legs) {
      const auto* timed = std::get_if<TimedLeg>(&leg);
      const Checked checked =
          look(first_move(robot_, leg), timed == nullptr ? nullptr : &timed->trajectory, positions);
      if (!checked) {
        return checked;
      }
      follow(positions, leg);
    }
    return {};
  }

  [[nodiscard]] Positions end_of_legs() const {
    Positions positions = start_;
    for (const PathLeg& leg : program_.legs) {
      follow(positions, leg);
    }
    return positions;
  }

  void follow(Positions& positions, const PathLeg& leg) const {
    arrive(positions, first_move(robot_, leg));
    if (const auto* timed = std::get_if<TimedLeg>(&leg)) {
      arrive(positions, approach_of(robot_, timed->trajectory, timed->trajectory.end_s()));
    }
  }

  [[nodiscard]] double paced_s(const TimedTrajectory& trajectory) const {
    return pace_along(trajectory, trajectory.begin_s(),
                      [this](std::uint32_t slot) { return limits_of(*robot_.at_slot(slot)); })
        .duration_s();
  }

  const Robot& robot_;
  const ControlView& view_;
  const PathProgram& program_;
  Positions start_{};
  double duration_s_ = 0.0;
};

}  // namespace

void check_axes(const Robot& robot, const ControlView& view, std::uint32_t mask, CheckList& checks) {
  const auto of_each = [&](const auto& check) {
    Checked checked;
    for (const Axis& axis : robot.axes) {
      if (checked && ((mask >> axis.slot) & 1u) != 0) {
        checked = check(axis);
      }
    }
    return checked;
  };
  checks.make(CheckName::axes,
              [&] { return of_each([&](const Axis& axis) { return check_free_axis(axis, view); }); });
  checks.make(CheckName::homed, [&] {
    return of_each([&](const Axis& axis) -> Checked {
      if (view.snapshot.state.axis[axis.slot].homed == 0) {
        return tl::make_unexpected(Refusal{"NOT_HOMED",
                                           axis.name + " is not homed, so it cannot go to a position.",
                                           "homed axes", "Home " + axis.name + " first."});
      }
      return {};
    });
  });
}

tl::expected<PathPreview, Refusal> check_path(const Robot& robot, const ilk_config_t& config,
                                              const ControlView& view, const PathProgram& program,
                                              CheckList& checks) {
  PathCheck check(robot, view, program);
  check_system(config, view, checks);
  check_axes(robot, view, program.mask(), checks);
  checks.make(CheckName::range, [&] { return check.ranges(); });
  checks.make(CheckName::separation, [&] { return check.separation(); });
  checks.make(CheckName::rates, [&] { return check.rates(); });
  return checks.outcome().map([&] { return check.preview(); });
}

namespace {

class PathKind final : public MotionKind {
 public:
  [[nodiscard]] std::string_view name() const override { return "path"; }
  [[nodiscard]] const std::type_info& tasks() const override { return typeid(PathTask); }
  [[nodiscard]] std::unique_ptr<Mode> make_mode(const RobotPlan& plan) const override {
    return std::make_unique<PathMode>(plan);
  }

  [[nodiscard]] std::vector<std::uint32_t> slots(const Robot& robot, const Work& work) const override {
    std::vector<std::uint32_t> slots;
    for (const Axis& axis : robot.axes) {
      if (((work.as<PathTask>().program->mask() >> axis.slot) & 1u) != 0) {
        slots.push_back(axis.slot);
      }
    }
    return slots;
  }

  void check(const Scene& scene, Proposal& proposal, CheckList& checks) const override {
    const PathProgram& program = *proposal.work<PathTask>()->program;
    if (auto preview = check_path(scene.robot, scene.config, scene.view, program, checks)) {
      proposal.ends = std::move(preview->ends);
      proposal.duration_s = preview->duration_s;
    }
  }

  void follow(const Scene& /*scene*/, const TaskStatus& status, Proposal& proposal) const override {
    proposal.leg = status.step;
  }

  [[nodiscard]] json asked(const Robot& robot, const Work& work) const override {
    json axes = json::array();
    for (const std::uint32_t slot : slots(robot, work)) {
      axes.push_back(robot.at_slot(slot)->name);
    }
    json asked{{"axes", std::move(axes)}};
    if (const auto& line = work.as<PathTask>().program->line) {
      asked["line_mm"] = line->length_mm;
    }
    return asked;
  }

  void add_fields(const Proposal& proposal, json& fields) const override {
    json ends = json::array();
    for (const AxisCounts& end : proposal.ends) {
      ends.push_back({{"slot", end.slot}, {"target_counts", end.counts}});
    }
    if (const auto& line = proposal.work<PathTask>()->program->line) {
      fields["line"] = {{"length_mm", line->length_mm},
                        {"allowed_mm", line->allowed_mm},
                        {"planned_mm", line->planned_mm},
                        {"keep", line->keeps_direction ? "direction" : "entry"}};
    }
    fields["legs"] = proposal.work<PathTask>()->program->legs.size();
    fields["leg"] = proposal.leg;
    fields["duration_s"] = proposal.duration_s;
    fields["ends"] = std::move(ends);
  }

  [[nodiscard]] TaskWords words(const Robot& robot, const Proposal& proposal, const TaskStatus& status,
                                const BiopsyFindings& /*found*/) const override {
    const std::size_t legs = proposal.work<PathTask>()->program->legs.size();
    const std::string part =
        legs > 1 ? ", part " + std::to_string(status.step + 1) + " of " + std::to_string(legs) : "";
    return {"", "Moves " + listed(robot, proposal.slots) + " while the pedal is held" + part,
            paused_words(part), "All axes rest within the deadband of their goals.",
            title_of(robot, status.slot)};
  }

  [[nodiscard]] Profile profile(const Robot& robot, const ilk_config_t& config,
                                const Proposal& proposal) const override {
    return profile_of_path(robot, config, proposal);
  }
};

}  // namespace

const MotionKind& path_kind();
const MotionKind& path_kind() {
  static const PathKind kind;
  return kind;
}

}  // namespace interlock
