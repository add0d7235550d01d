#include "demo/targeting_demo.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "proposals/pose_program.hpp"

namespace interlock {
namespace {

/** A registration anywhere within a room, turned in any way. */
Registration random_registration(std::mt19937_64& random) {
  std::normal_distribution<double> component;
  std::uniform_real_distribution<double> offset_mm(-500.0, 500.0);
  Eigen::Vector4d turn;
  Eigen::Vector3d offset;
  std::ranges::generate(turn, [&] { return component(random); });
  std::ranges::generate(offset, [&] { return offset_mm(random); });
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond(turn).normalized().toRotationMatrix();
  pose.translation() = offset;
  // Rigid by construction, so never refused.
  return Registration::create(row_major(pose)).value();
}

bool is_clamped(const Alignment& alignment) {
  return std::ranges::any_of(alignment.setpoints, &AxisSetpoint::clamped);
}

/** Everything that a target needs. */
class Demo {
 public:
  Demo(const Robot& robot, const RobotKinematics& kinematics, RobotRig& rig, const Registration& registration)
      : robot_(robot), kinematics_(kinematics), rig_(rig), registration_(registration) {}

  DemoResult<DemoTrial> carry_out(const ThesisTrial& trial) {
    const Pose& scanner = registration_.scanner_from_zframe();
    const Way way = way_of(robot_, trial);
    DemoTrial done;
    done.desired = scanner * way.target;
    done.thesis_error = trial.actual - trial.desired;
    const auto alignment =
        align(robot_, kinematics_, registration_, {scanner * way.entry, done.desired, 0.0});
    if (!alignment) {
      done.refused = alignment.error().message();
      return done;
    }
    if (is_clamped(*alignment)) {
      done.refused = "an axis would have to go beyond its range";
      return done;
    }
    const double begun_s = rig_.time_s();
    const PathProgram program = pose_program(robot_, *alignment, true);
    return rig_.carry_out(program).and_then([&]() -> DemoResult<DemoTrial> {
      done.time_s = rig_.time_s() - begun_s;
      return scan().map([&](const Pose& pose) {
        done.reached = pose.translation();
        return done;
      });
    });
  }

 private:
  /** The treatment point as a scan would show it. */
  [[nodiscard]] DemoResult<Pose> scan() const {
    return kinematics_.zframe_from_treatment(rig_.true_positions())
        .map([this](const Pose& pose) -> Pose { return registration_.scanner_from_zframe() * pose; })
        .map_error([](const KinematicsError& error) { return error.message(); });
  }

  const Robot& robot_;
  const RobotKinematics& kinematics_;
  RobotRig& rig_;
  const Registration& registration_;
};

/** Positions of all axes, each within what the kernel accepts. */
AxisPositions random_positions(const Robot& robot, std::mt19937_64& random) {
  AxisPositions positions;
  for (const Axis& axis : robot.axes) {
    std::uniform_real_distribution<double> anywhere(axis.to_unit(axis.lowest_setpoint_counts()),
                                                    axis.to_unit(axis.highest_setpoint_counts()));
    positions.push_back(anywhere(random));
  }
  return positions;
}

/** A way in that ends where these positions put the treatment point. */
KinematicsResult<Way> way_to(const Robot& robot, const RobotKinematics& kinematics,
                             const AxisPositions& positions) {
  return kinematics.zframe_from_treatment(positions).map([&](const Pose& pose) {
    double depth_mm = 50.0;
    if (std::holds_alternative<NeuroRcm>(robot.kinematics)) {
      const auto place = std::ranges::find(robot.axes, "insertion", &Axis::role) - robot.axes.begin();
      depth_mm = positions[static_cast<std::size_t>(place)] +
                 kinematics.probe().treatment_to_robot_at_home_mm - kinematics.probe().robot_to_entry_mm;
    }
    const Eigen::Vector3d target = pose.translation();
    return Way{target - depth_mm * pose.linear().col(2), target};
  });
}

RandomTargets reach_random(const Robot& robot, const RobotKinematics& kinematics,
                           const Registration& registration, std::size_t count, std::mt19937_64& random) {
  RandomTargets result;
  const Pose& scanner = registration.scanner_from_zframe();
  double squares = 0.0;
  std::size_t reached = 0;
  for (; result.tried < count; ++result.tried) {
    const auto alignment =
        way_to(robot, kinematics, random_positions(robot, random)).and_then([&](const Way& way) {
          return align(robot, kinematics, registration, {scanner * way.entry, scanner * way.target, 0.0});
        });
    if (!alignment || is_clamped(*alignment)) {
      ++result.refused;
      continue;
    }
    const double distance = alignment->deviation.distance_mm;
    squares += distance * distance;
    result.worst_mm = std::max(result.worst_mm, distance);
    ++reached;
  }
  result.rms_mm = reached == 0 ? 0.0 : std::sqrt(squares / static_cast<double>(reached));
  return result;
}

}  // namespace

DemoResult<DemoReport> run_demo(const Robot& robot, const ilk_config_t& config,
                                const plant::Parameters& parameters, const DemoOptions& options,
                                const DemoProgress& progress) {
  const auto kinematics = RobotKinematics::create(robot);
  if (!kinematics) {
    return tl::unexpected(kinematics.error().message());
  }
  std::mt19937_64 random(options.seed);
  const Registration registration = random_registration(random);
  RobotRig rig(robot, config, parameters, options.seed);
  progress("homing");
  if (const auto ready = rig.make_ready(); !ready) {
    return tl::unexpected(ready.error());
  }
  DemoReport report;
  Demo demo(robot, *kinematics, rig, registration);
  for (const ThesisTrial& trial : thesis_table(robot).trials) {
    progress("target " + std::to_string(report.trials.size() + 1));
    auto done = demo.carry_out(trial);
    if (!done) {
      return tl::unexpected("target " + std::to_string(report.trials.size() + 1) + ": " + done.error());
    }
    report.trials.push_back(std::move(*done));
  }
  if (!robot.draping.empty()) {
    progress("draping");
    const PathProgram removal{{MoveLeg{robot.draping, 0.0, 0.0}}};
    if (const auto draped = rig.carry_out(removal); !draped) {
      return tl::unexpected("draping: " + draped.error());
    }
  }
  progress("random targets");
  report.random = reach_random(robot, *kinematics, registration, options.random_targets, random);
  return report;
}

}  // namespace interlock
