#include "proposals/profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "motion/axis_move.hpp"
#include "motion/axis_plan.hpp"
#include "motion/trajectory_follower.hpp"
#include "proposals/motion_kind.hpp"

namespace interlock {
namespace {

/** Between two samples so many steps are looked at, so that the extremes told are those of the motion. */
constexpr std::size_t steps_per_sample = 10;
constexpr std::size_t intervals = Profile::most_samples - 2;
constexpr std::size_t way_intervals = 100;

AxisProfile frame_of(const ilk_config_t& config, const Robot& robot, const ilk_state_t& state,
                     std::uint32_t slot) {
  const ilk_axis_config_t& rules = config.axis[slot];
  AxisProfile axis;
  axis.slot = slot;
  axis.homed = state.axis[slot].homed != 0;
  axis.allowed = setpoint_range(rules, state.axis[slot], state.system.mode);
  axis.soft_limits = robot.at_slot(slot)->soft_limits;
  axis.most_drive = drive_bound(rules, state.axis[slot]);
  axis.lowest = std::numeric_limits<double>::infinity();
  axis.highest = -axis.lowest;
  return axis;
}

void look_at(AxisProfile& axis, double position, double velocity) {
  axis.lowest = std::min(axis.lowest, position);
  axis.highest = std::max(axis.highest, position);
  axis.fastest = std::max(axis.fastest, std::abs(velocity));
}

/** Walks a path as the control thread does, without a robot: from leg to leg, each from where the one before
 * ends. */
class DryWalk {
 public:
  DryWalk(const RobotPlan& plan, const PathProgram& program, const ilk_snapshot_t& start)
      : program_(program), snapshot_(start), walk_(plan) {}

  /** `see(time, points)` at the start, at each step of at most `step_s`, and at each end. False: there is no
   * such way. `points` are those of the leg under way, which `mask` names. */
  template <typename See>
  bool go(double step_s, const See& see) {
    double time_s = 0.0;
    for (const PathLeg& leg : program_.legs) {
      walk_.take(leg);
      if (!walk_.begin(snapshot_, {})) {
        return false;
      }
      see(time_s, walk_.mask(), walk_.points());
      do {
        while (!walk_.at_end()) {
          const double step = std::min(step_s, walk_.left_s());
          walk_.advance(step);
          time_s += step;
          see(time_s, walk_.mask(), walk_.points());
        }
      } while (walk_.go_on());
      time_s += walk_.dwell_s();
      see(time_s, walk_.mask(), walk_.points());
      stand_at(walk_.mask(), walk_.points());
    }
    duration_s_ = time_s;
    return true;
  }

  /** Of the whole way, once gone. */
  [[nodiscard]] double duration_s() const { return duration_s_; }

 private:
  void stand_at(std::uint32_t mask, const TrajectoryFollower::Points& points) {
    for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
      if (((mask >> slot) & 1u) != 0) {
        snapshot_.state.axis[slot].position_counts =
            saturated(std::llround(points[slot].now.position_counts));
      }
    }
  }

  const PathProgram& program_;
  ilk_snapshot_t snapshot_;
  TrajectoryFollower walk_;
  double duration_s_ = 0.0;
};

/** Fills a profile with what a walk passes. */
class Sampler {
 public:
  Sampler(Profile& profile, const ilk_state_t& start, double every_s) : profile_(profile), every_s_(every_s) {
    for (const AxisProfile& axis : profile.axes) {
      last_.push_back({static_cast<double>(start.axis[axis.slot].position_counts), 0.0, 0.0});
    }
  }

  void see(double time_s, std::uint32_t mask, const TrajectoryFollower::Points& points) {
    for (std::size_t place = 0; place < profile_.axes.size(); ++place) {
      AxisProfile& axis = profile_.axes[place];
      const bool moves = ((mask >> axis.slot) & 1u) != 0;
      last_[place] = moves ? points[axis.slot].now : Setpoint{last_[place].position_counts, 0.0, 0.0};
      look_at(axis, last_[place].position_counts, last_[place].velocity_counts_per_s);
    }
    last_s_ = time_s;
    if (time_s >= next_s_) {
      take();
      next_s_ = time_s + every_s_;
    }
  }

  /** The last state, where it is no sample yet. */
  void finish() {
    if (profile_.times_s.empty() || profile_.times_s.back() < last_s_) {
      take();
    }
  }

 private:
  void take() {
    profile_.times_s.push_back(last_s_);
    for (std::size_t place = 0; place < profile_.axes.size(); ++place) {
      profile_.axes[place].positions.push_back(last_[place].position_counts);
      profile_.axes[place].velocities.push_back(last_[place].velocity_counts_per_s);
    }
  }

  Profile& profile_;
  double every_s_;
  double next_s_ = 0.0;
  double last_s_ = 0.0;
  std::vector<Setpoint> last_;
};

}  // namespace

Profile no_profile(std::string why) {
  Profile profile;
  profile.why = std::move(why);
  return profile;
}

Profile profile_of_path(const Robot& robot, const ilk_config_t& config, const Proposal& proposal) {
  const ilk_snapshot_t& start = *proposal.checked_against;
  const RobotPlan plan(robot, config);
  const PathProgram& program = *proposal.work<PathTask>()->program;
  DryWalk measured(plan, program, start);
  const auto unseen = [](double, std::uint32_t, const TrajectoryFollower::Points&) {};
  if (!measured.go(std::numeric_limits<double>::infinity(), unseen)) {
    return no_profile("No motion within the rates of the axes leads there from where they were.");
  }
  Profile profile;
  profile.basis = ProfileBasis::time;
  for (const std::uint32_t slot : proposal.slots) {
    profile.axes.push_back(frame_of(config, robot, start.state, slot));
    profile.axes.back().top_velocity = plan.axis[slot].rates.velocity_counts_per_s;
  }
  const double every_s = std::max(plan.period_s(), measured.duration_s() / intervals);
  Sampler sampler(profile, start.state, every_s);
  DryWalk walk(plan, program, start);
  (void)walk.go(every_s / steps_per_sample, [&](double time_s, std::uint32_t mask, const auto& points) {
    sampler.see(time_s, mask, points);
  });
  sampler.finish();
  return profile;
}

Profile profile_of_move(const Robot& robot, const ilk_config_t& config, const Proposal& proposal) {
  const ilk_state_t& start = proposal.checked_against->state;
  const MoveTask& move = *proposal.work<MoveTask>();
  const std::uint32_t slot = move.slot;
  const RobotPlan plan(robot, config);
  const DriveLaw law = AxisMove::law_of(plan.axis[slot], start.axis[slot], move.drive.value_or(0));
  const std::int64_t from = start.axis[slot].position_counts;
  const std::int64_t way = move.target_counts - from;
  Profile profile;
  profile.basis = ProfileBasis::way;
  AxisProfile axis = frame_of(config, robot, start, slot);
  const auto samples = std::min<std::int64_t>(std::abs(way), way_intervals);
  for (std::int64_t sample = 0; sample <= samples; ++sample) {
    const std::int64_t passed = samples == 0 ? 0 : way * sample / samples;
    const auto position = static_cast<double>(from + passed);
    axis.positions.push_back(position);
    axis.drives.push_back(passed == way ? 0 : law.at(static_cast<std::uint64_t>(std::abs(way - passed))));
    look_at(axis, position, 0.0);
  }
  profile.axes.push_back(std::move(axis));
  return profile;
}

Profile profile_of(const Robot& robot, const ilk_config_t& config, const Proposal& proposal) {
  if (proposal.checked_against == nullptr) {
    return no_profile("It was not checked, so nothing was planned.");
  }
  return kind_of(proposal.task->work).profile(robot, config, proposal);
}

}  // namespace interlock
