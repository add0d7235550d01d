#include "targeting_demo.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "proposals/programs.hpp"
#include "targeting/guide_frame.hpp"

namespace interlock {
namespace {

/** Nobody has to look at the robot of the study before it inserts. */
PathProgram confirmed(PathProgram program) {
  for (PathLeg& leg : program.legs) {
    if (auto* move = std::get_if<MoveLeg>(&leg)) {
      move->needs_confirmation = false;
    }
  }
  return program;
}

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

/** About the zFrame of the robot, mm, none on a line with the others. */
const std::vector<Eigen::Vector3d> fiducials{
    {-40, 0, 0}, {40, 0, 10}, {-30, 60, 0}, {35, 50, 40}, {0, 20, 60}};

/** A registration as it was found, and how well it fits. */
struct FoundRegistration {
  Registration registration;
  std::optional<RegistrationFit> fit; /**< nothing: it is the true one */
};

FoundRegistration found_registration(const Registration& truth, double fiducial_sd_mm,
                                     std::mt19937_64& random) {
  if (fiducial_sd_mm == 0.0) {
    return {truth, std::nullopt};
  }
  std::normal_distribution<double> off_mm(0.0, fiducial_sd_mm);
  const auto count = static_cast<Eigen::Index>(fiducials.size());
  Eigen::Matrix3Xd on_robot(3, count);
  Eigen::Matrix3Xd seen(3, count);
  RegistrationFit fit;
  for (Eigen::Index each = 0; each < count; ++each) {
    on_robot.col(each) = fiducials[static_cast<std::size_t>(each)];
    seen.col(each) = truth.scanner_from_zframe() * on_robot.col(each) +
                     Eigen::Vector3d(off_mm(random), off_mm(random), off_mm(random));
    fit.fiducials_mm.emplace_back(seen.col(each));
  }
  const Pose found(Eigen::umeyama(on_robot, seen, false));
  fit.residual_mm = std::sqrt((seen - found * on_robot).colwise().squaredNorm().mean());
  return {Registration::create(row_major(found)).value(), fit};
}

/** After so many the last one stays, however far off. */
constexpr std::size_t most_insertions = 3;

bool is_clamped(const Alignment& alignment) {
  return std::ranges::any_of(alignment.setpoints, &AxisSetpoint::clamped);
}

/** Places of the probe about a treated target: round it at the target itself, then a little nearer. */
constexpr std::array ablation_angles_rad{0.0, std::numbers::pi / 2, std::numbers::pi, -std::numbers::pi / 2};
constexpr std::array ablation_retreats_mm{0.0, 5.0};

/** Through every angle at every depth, beginning where the probe is. */
std::optional<PathProgram> ablation_of(const Robot& robot, double insertion_mm, double dwell_s) {
  PathProgram program;
  for (const double retreat_mm : ablation_retreats_mm) {
    for (const double angle_rad : ablation_angles_rad) {
      const auto leg = ablation_leg(robot, {angle_rad, insertion_mm - retreat_mm, dwell_s});
      const bool reachable = leg && std::ranges::all_of(leg->targets, [&](const AxisCounts& target) {
                               return robot.at_slot(target.slot)->accepts_setpoint(target.counts);
                             });
      if (!reachable) {
        return std::nullopt;
      }
      program.legs.emplace_back(*leg);
    }
  }
  return program;
}

/** The probe or needle out as far as it goes, then the robot to where its file wants it for removal. */
PathProgram removal_of(const Robot& robot) {
  const Axis& insertion = *robot.with_role("insertion");
  PathProgram removal{{MoveLeg{{{insertion.slot, insertion.lowest_setpoint_counts()}}, 0.0, 0.0}}};
  if (!robot.draping.empty()) {
    removal.legs.emplace_back(MoveLeg{robot.draping, 0.0, 0.0});
  }
  return removal;
}

/** Everything that a target needs. */
class Demo {
 public:
  /** @param truth where the robot stands in the scanner */
  Demo(const Robot& robot, const RobotKinematics& kinematics, const RobotKinematics& true_kinematics,
       RobotRig& rig, const Registration& truth, const DemoOptions& options, const DemoAudience& audience)
      : robot_(robot),
        kinematics_(kinematics),
        true_kinematics_(true_kinematics),
        rig_(rig),
        truth_(truth),
        options_(options),
        audience_(audience),
        // Chance of its own: the random targets are the same with and without other errors.
        random_(options.seed + 1),
        tracking_(robot.axes.size()) {}

  /** Another registration, and what is expected of it from now on. */
  void register_anew() { registered_ = found_registration(truth_, options_.fiducial_sd_mm, random_); }

  [[nodiscard]] const std::vector<Tracking>& tracking() const { return tracking_; }

  /** @param name of the visit, for files; empty: its motions are not shown */
  DemoResult<DemoTrial> carry_out(std::size_t target, const std::string& name) {
    const double begun_s = rig_.time_s();
    name_ = name;
    DemoResult<DemoTrial> done = reach(target);
    if (!done || !done->refused.empty()) {
      return done;
    }
    done->time_s = rig_.time_s() - begun_s;
    if (can_ablate(robot_) && !options_.targeting_only) {
      if (const auto ablated = ablate(*done); !ablated) {
        return failed("ablation: ", ablated.error());
      }
    }
    if (!options_.targeting_only) {
      if (const auto removed = rig_.carry_out(removal_of(robot_)); !removed) {
        return failed("removal: ", removed.error());
      }
    }
    return done;
  }

  /** An error in the scanner's frame, in the axes of the table. */
  [[nodiscard]] Eigen::Vector3d in_table(const Eigen::Vector3d& error) const {
    return zframe_from_table(robot_).transpose() *
           (truth_.scanner_from_zframe().linear().transpose() * error);
  }

 private:
  static tl::unexpected<std::string> failed(const char* what, const std::string& why) {
    return tl::unexpected(what + why);
  }

  [[nodiscard]] bool takes_biopsies() const { return robot_.biopsy && !options_.targeting_only; }

  /** Aims, inserts and scans, until the target is met or was tried often enough. */
  DemoResult<DemoTrial> reach(std::size_t target) {
    const ThesisTrial& trial = thesis_table(robot_).trials[target - 1];
    const Pose& scanner = truth_.scanner_from_zframe();
    const Way way = way_of(robot_, trial);
    DemoTrial done{.target = target,
                   .desired = scanner * way.target,
                   .reached = {},
                   .thesis_error = trial.actual - trial.desired,
                   .time_s = 0.0,
                   .refused = {},
                   .ablation = {},
                   .biopsy = {}};
    // The second needle into the same tissue would follow the first one's way.
    const std::size_t most = takes_biopsies() ? 1 : most_insertions;
    Eigen::Vector3d seen_off = Eigen::Vector3d::Zero();
    Eigen::Vector3d correction = Eigen::Vector3d::Zero();
    while (done.reached.size() < most) {
      const auto alignment = align(robot_, kinematics_, registered_.registration,
                                   {scanner * way.entry + correction,
                                    done.desired + correction,
                                    0.0,
                                    {registered_.fit, std::nullopt}});
      if (!alignment || is_clamped(*alignment)) {
        if (done.reached.empty()) {
          done.refused =
              alignment ? "an axis would have to go beyond its range" : alignment.error().message();
        }
        return done;
      }
      const auto reached = takes_biopsies() ? push(*alignment, way, done) : insert(*alignment, done);
      if (!reached) {
        return tl::unexpected(reached.error());
      }
      done.reached.push_back(*reached);
      if (done.reached.size() == 1 && alignment->error_budget) {
        const ErrorEllipsoid& claim = alignment->error_budget->treatment;
        const Eigen::Vector3d off = claim.directions.transpose() * (*reached - claim.centre_mm);
        done.claimed_mm = claim.half_axes_mm.x();
        done.within_claim = off.cwiseQuotient(claim.half_axes_mm).norm() <= 1.0;
      }
      if (done.error().norm() <= options_.tolerance_mm) {
        return done;
      }
      // The mean of what each insertion was off from where it aimed: one scan alone shows chance, too.
      seen_off += *reached - done.desired - correction;
      correction = -seen_off / static_cast<double>(done.reached.size());
    }
    return done;
  }

  /** Takes the probe out, aligns and inserts; where the scan then shows the treatment point. */
  DemoResult<Eigen::Vector3d> insert(const Alignment& alignment, const DemoTrial& trial) {
    const auto reached = rig_.carry_out(confirmed(program_of(alignment, true))).and_then([&] {
      return true_kinematics_.zframe_from_treatment(rig_.true_positions())
          .map([this](const Pose& pose) { return scanned(pose.translation()); })
          .map_error([](const KinematicsError& error) { return error.message(); });
    });
    show("insertion-" + std::to_string(trial.reached.size() + 1));
    return reached;
  }

  /** Takes the needle out, lines up, and has it pushed to the target; where the scan then shows its tip. */
  DemoResult<Eigen::Vector3d> push(const Alignment& alignment, const Way& way, DemoTrial& trial) {
    const auto lined_up = rig_.carry_out(program_of(alignment, false));
    show("alignment");
    return lined_up.and_then([&] { return guide(kinematics_, rig_.positions()); })
        .and_then(
            [&](const Pose& planned) { return rig_.take_biopsy(planned.inverse() * way.target, random_()); })
        .and_then([&](const NeedleInsertion& pushed) {
          show("biopsy");
          trial.biopsy = pushed;
          return guide(true_kinematics_, rig_.true_positions()).map([&](const Pose& pose) {
            return scanned(pose * pushed.tip_mm);
          });
        });
  }

  [[nodiscard]] PathProgram program_of(const Alignment& alignment, bool insert) const {
    return arriving_from_below(robot_, pose_program(robot_, alignment, insert));
  }

  [[nodiscard]] DemoResult<Pose> guide(const RobotKinematics& kinematics,
                                       const AxisPositions& positions) const {
    return zframe_from_guide(robot_, kinematics, positions).map_error([](const KinematicsError& error) {
      return error.message();
    });
  }

  /** A point of the zFrame as a scan shows it. */
  [[nodiscard]] Eigen::Vector3d scanned(const Eigen::Vector3d& in_zframe) const {
    return truth_.scanner_from_zframe() * in_zframe;
  }

  DemoResult<void> ablate(DemoTrial& trial) {
    const Axis& insertion = *robot_.with_role("insertion");
    const double inserted_mm = rig_.positions()[static_cast<std::size_t>(&insertion - robot_.axes.data())];
    const auto program = ablation_of(robot_, inserted_mm, options_.dwell_s);
    if (!program) {
      return tl::unexpected(std::string("an angle or a depth is beyond the axes"));
    }
    const double begun_s = rig_.time_s();
    const auto done = rig_.carry_out(*program);
    show("ablation");
    trial.ablation = {program->legs.size(), rig_.time_s() - begun_s};
    return done;
  }

  void show(const std::string& motion) {
    if (name_.empty()) {
      return;
    }
    const MotionRecord& record = rig_.record();
    audience_.motion(name_ + "-" + motion, record);
    for (std::size_t axis = 0; axis < record.axes.size(); ++axis) {
      for (const AxisSample& sample : record.axes[axis]) {
        if (sample.setpoint) {
          const double off = std::abs(sample.setpoint->position_counts - sample.position_counts);
          tracking_[axis].squares += off * off;
          tracking_[axis].worst_counts = std::max(tracking_[axis].worst_counts, off);
          ++tracking_[axis].samples;
        }
      }
    }
  }

  const Robot& robot_;
  const RobotKinematics& kinematics_;
  const RobotKinematics& true_kinematics_;
  RobotRig& rig_;
  const Registration& truth_;
  FoundRegistration registered_;
  const DemoOptions& options_;
  const DemoAudience& audience_;
  std::mt19937_64 random_;
  std::vector<Tracking> tracking_;
  std::string name_;
};

/** With each axis that has a switch anywhere in the half of its range before that. */
plant::Parameters scattered(plant::Parameters parameters, const Robot& robot, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  for (const Axis& axis : robot.axes) {
    if (axis.homing) {
      const auto [low, high] = axis.soft_limits;
      const std::int32_t middle = low + (high - low) / 2;
      parameters.axis[axis.slot].start_counts =
          axis.limit == ILK_LIMIT_UPPER ? std::uniform_real_distribution<double>(middle, high)(random)
                                        : std::uniform_real_distribution<double>(low, middle)(random);
    }
  }
  return parameters;
}

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
KinematicsResult<Way> way_to(const RobotKinematics& kinematics, const AxisPositions& positions) {
  return kinematics.zframe_from_treatment(positions).map([&](const Pose& pose) {
    const double depth_mm = kinematics.depth_mm(positions).value_or(50.0);
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
    const auto alignment = way_to(kinematics, random_positions(robot, random)).and_then([&](const Way& way) {
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

/** With a phantom a millimetre in front of the needle when it is out, so that all targets are in it. */
Robot before_phantom(Robot robot) {
  constexpr double gap_mm = 1.0;
  if (const Axis* insertion = robot.with_role("insertion"); robot.biopsy && insertion != nullptr) {
    robot.biopsy->entry_mm = insertion->to_unit(insertion->lowest_setpoint_counts()) + gap_mm;
  }
  return robot;
}

}  // namespace

DemoResult<DemoReport> run_demo(const Robot& described, const plant::Parameters& parameters,
                                const DemoOptions& options, const DemoAudience& audience) {
  if (!has_thesis_table(described)) {
    return tl::unexpected(described.name + " has no trials in the thesis; run neuro or prostate");
  }
  const Robot robot = before_phantom(described);
  const auto kinematics = RobotKinematics::create(robot);
  if (!kinematics) {
    return tl::unexpected(kinematics.error().message());
  }
  const auto true_kinematics = RobotKinematics::create(options.true_robot.value_or(robot));
  if (!true_kinematics) {
    return tl::unexpected(true_kinematics.error().message());
  }
  std::mt19937_64 random(options.seed);
  const Registration registration = random_registration(random);
  RobotRig rig(robot, options.scattered ? scattered(parameters, robot, options.seed) : parameters,
               options.seed);
  audience.progress("homing");
  if (const auto ready = rig.make_ready(); !ready) {
    return tl::unexpected(ready.error());
  }
  DemoReport report;
  report.homing_counts = rig.homing_counts();
  Demo demo(robot, *kinematics, *true_kinematics, rig, registration, options, audience);
  std::vector<Eigen::Vector3d> first_errors;
  std::vector<Eigen::Vector3d> last_errors;
  const std::size_t targets = thesis_table(robot).trials.size();
  for (std::size_t visit = 0; visit < options.rounds * targets; ++visit) {
    const std::string name = "target " + std::to_string(visit % targets + 1) +
                             (options.rounds == 1 ? "" : ", round " + std::to_string(visit / targets + 1));
    audience.progress(name);
    if (visit % targets == 0) {
      demo.register_anew();
    }
    auto done = demo.carry_out(visit % targets + 1,
                               visit < targets ? "target-" + std::to_string(visit + 1) : std::string());
    if (!done) {
      return tl::unexpected(name + ": " + done.error());
    }
    if (done->refused.empty()) {
      first_errors.push_back(demo.in_table(done->first_error()));
      last_errors.push_back(demo.in_table(done->error()));
    }
    report.trials.push_back(std::move(*done));
  }
  report.tracking = demo.tracking();
  report.first_scan = distribution_of(first_errors);
  report.last_scan = distribution_of(last_errors);
  report.thesis = published_distribution(robot);
  if (options.rounds > 0 && options.targeting_only && !robot.draping.empty()) {
    audience.progress("draping");
    const PathProgram removal{{MoveLeg{robot.draping, 0.0, 0.0}}};
    if (const auto draped = rig.carry_out(removal); !draped) {
      return tl::unexpected("draping: " + draped.error());
    }
  }
  audience.progress("random targets");
  report.random = reach_random(robot, *kinematics, registration, options.random_targets, random);
  return report;
}

}  // namespace interlock
