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

/** After so many the last one stays, however far off. */
constexpr std::size_t most_insertions = 3;

bool is_clamped(const Alignment& alignment) {
  return std::ranges::any_of(alignment.setpoints, &AxisSetpoint::clamped);
}

/** Everything that a target needs. */
class Demo {
 public:
  Demo(const Robot& robot, const RobotKinematics& kinematics, RobotRig& rig, const Registration& registration,
       const MechanicalError& mechanical, double tolerance_mm, std::mt19937_64& random)
      : robot_(robot),
        kinematics_(kinematics),
        rig_(rig),
        registration_(registration),
        mechanical_(mechanical),
        tolerance_mm_(tolerance_mm),
        random_(random) {}

  DemoResult<DemoTrial> carry_out(std::size_t target) {
    const ThesisTrial& trial = thesis_table(robot_).trials[target - 1];
    const Pose& scanner = registration_.scanner_from_zframe();
    const Way way = way_of(robot_, trial);
    DemoTrial done{.target = target,
                   .desired = scanner * way.target,
                   .reached = {},
                   .thesis_error = trial.actual - trial.desired,
                   .time_s = 0.0,
                   .refused = {}};
    const double begun_s = rig_.time_s();
    Eigen::Vector3d seen_off = Eigen::Vector3d::Zero();
    Eigen::Vector3d correction = Eigen::Vector3d::Zero();
    while (done.reached.size() < most_insertions) {
      const auto alignment = align(robot_, kinematics_, registration_,
                                   {scanner * way.entry + correction, done.desired + correction, 0.0});
      if (!alignment || is_clamped(*alignment)) {
        if (done.reached.empty()) {
          done.refused =
              alignment ? "an axis would have to go beyond its range" : alignment.error().message();
        }
        return done;
      }
      const auto reached = insert(*alignment);
      if (!reached) {
        return tl::unexpected(reached.error());
      }
      done.reached.push_back(*reached);
      done.time_s = rig_.time_s() - begun_s;
      if (done.error().norm() <= tolerance_mm_) {
        return done;
      }
      // The mean of what each insertion was off from where it aimed: one scan alone shows chance, too.
      seen_off += *reached - done.desired - correction;
      correction = -seen_off / static_cast<double>(done.reached.size());
    }
    return done;
  }

  /** An error in the scanner's frame, in the axes of the table. */
  [[nodiscard]] Eigen::Vector3d in_table(const Eigen::Vector3d& error) const {
    return zframe_from_table(robot_).transpose() *
           (registration_.scanner_from_zframe().linear().transpose() * error);
  }

 private:
  /** Takes the probe out, aligns and inserts; where the scan then shows the treatment point. */
  DemoResult<Eigen::Vector3d> insert(const Alignment& alignment) {
    return rig_.carry_out(pose_program(robot_, alignment, true))
        .and_then([&]() -> DemoResult<Eigen::Vector3d> {
          return kinematics_.zframe_from_treatment(rig_.true_positions())
              .map([this](const Pose& pose) -> Eigen::Vector3d {
                const Eigen::Vector3d behind = zframe_from_table(robot_) * mechanical_.draw(random_);
                return registration_.scanner_from_zframe() * (pose.translation() + behind);
              })
              .map_error([](const KinematicsError& error) { return error.message(); });
        });
  }

  const Robot& robot_;
  const RobotKinematics& kinematics_;
  RobotRig& rig_;
  const Registration& registration_;
  const MechanicalError& mechanical_;
  double tolerance_mm_;
  std::mt19937_64& random_;
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
  if (options.mechanical_error) {
    report.injected = published_error(robot);
  }
  // Chance of its own: the random targets are the same with and without an injected error.
  std::mt19937_64 chance(options.seed + 1);
  Demo demo(robot, *kinematics, rig, registration, report.injected, options.tolerance_mm, chance);
  std::vector<Eigen::Vector3d> first_errors;
  std::vector<Eigen::Vector3d> last_errors;
  const std::size_t targets = thesis_table(robot).trials.size();
  for (std::size_t visit = 0; visit < options.rounds * targets; ++visit) {
    const std::string name = "target " + std::to_string(visit % targets + 1) +
                             (options.rounds == 1 ? "" : ", round " + std::to_string(visit / targets + 1));
    progress(name);
    auto done = demo.carry_out(visit % targets + 1);
    if (!done) {
      return tl::unexpected(name + ": " + done.error());
    }
    if (done->refused.empty()) {
      first_errors.push_back(demo.in_table(done->first_error()));
      last_errors.push_back(demo.in_table(done->error()));
    }
    report.trials.push_back(std::move(*done));
  }
  report.first_scan = distribution_of(first_errors);
  report.last_scan = distribution_of(last_errors);
  report.thesis = published_distribution(robot);
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
