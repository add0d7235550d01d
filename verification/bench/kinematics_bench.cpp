/// Times forward and inverse kinematics of a robot in closed form, KDL's numerical inverse of an equivalent
/// serial chain, and planning anew a synchronised move from motion. Prints one JSON object.
///
/// Equivalent: the chain reaches the same poses. What the sliders do by their linkages (raise, shift,
/// angulate) it does by prismatic and revolute joints in their place; so KDL is spared the linkages, which
/// the closed form solves, too.
///
/// Usage: kinematics_bench ROBOT_FILE

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_lma.hpp>
#include <nlohmann/json.hpp>
#include <random>
#include <vector>

#include "kinematics/neuro_rcm/neuro_kinematics.hpp"
#include "kinematics/prostate_trapezoids/prostate_kinematics.hpp"
#include "robot/robot_file.hpp"
#include "timing.hpp"
#include "trajectory/tick_planner.hpp"

namespace interlock::bench {
namespace {

constexpr std::uint64_t kSeed = 1;
constexpr int kPoses = 20'000;
constexpr int kPlans = 20'000;
constexpr double kNeuroInsertion = 20.0;

using Generator = std::mt19937_64;

double between(Generator& generator, double lowest, double highest) {
  return std::uniform_real_distribution<double>(lowest, highest)(generator);
}

/// Random joints within the published ranges of the axes; the trapezoids may refuse them.
NeuroJoints draw(Generator& generator, const NeuroJoints* /*family*/) {
  return {between(generator, -145.0, 0.0),  between(generator, -70.0, 75.0),
          between(generator, -49.47, 0.0),  kNeuroInsertion,
          between(generator, -3.0, 3.0),    between(generator, -0.465, 0.648),
          between(generator, -1.536, 0.010)};
}

ProstateJoints draw(Generator& generator, const ProstateJoints* /*family*/) {
  return {between(generator, 43.0, 188.89), between(generator, -188.89, -43.0),
          between(generator, 43.0, 187.39), between(generator, -185.39, -43.0),
          between(generator, 0.0, 168.0),   between(generator, -3.0, 3.0)};
}

KinematicsResult<Pose> forward(const NeuroKinematics& robot, const NeuroJoints& joints) {
  return robot.zframe_from_treatment(joints);
}

KinematicsResult<Pose> forward(const ProstateKinematics& robot, const ProstateJoints& joints) {
  return robot.base_from_tip(joints);
}

/// One pose leaves the NeuroRobot a freedom: the insertion is given.
KinematicsResult<NeuroJoints> inverse(const NeuroKinematics& robot, const Pose& pose) {
  return robot.joints_at_insertion(pose, kNeuroInsertion);
}

KinematicsResult<ProstateJoints> inverse(const ProstateKinematics& robot, const Pose& pose) {
  return robot.joints_for(pose);
}

KDL::Segment moved(KDL::Joint::JointType type, const KDL::Frame& then = KDL::Frame::Identity()) {
  return KDL::Segment(KDL::Joint(type), then);
}

KDL::Chain chain_of(const NeuroRcm& geometry, const ProbeOffsets& probe) {
  const KDL::Rotation home(-1, 0, 0, 0, 0, -1, 0, -1, 0);
  const double along = kNeuroInsertion + probe.treatment_to_robot_at_home_mm - geometry.driver_to_rcm_mm;
  KDL::Chain chain;
  chain.addSegment(moved(KDL::Joint::TransX));
  chain.addSegment(moved(KDL::Joint::TransY));
  chain.addSegment(moved(KDL::Joint::TransZ, KDL::Frame(home)));
  chain.addSegment(moved(KDL::Joint::RotX));
  chain.addSegment(moved(KDL::Joint::RotY));
  chain.addSegment(moved(KDL::Joint::RotZ, KDL::Frame(KDL::Vector(0, 0, along))));
  return chain;
}

KDL::Chain chain_of(const ProstateTrapezoids& geometry, const ProbeOffsets& /*probe*/) {
  KDL::Chain chain;
  chain.addSegment(moved(KDL::Joint::TransX));
  chain.addSegment(moved(KDL::Joint::TransY, KDL::Frame(KDL::Vector(0, 0, -geometry.front_pivot_offset_mm))));
  chain.addSegment(moved(KDL::Joint::RotY));
  chain.addSegment(
      moved(KDL::Joint::RotX, KDL::Frame(KDL::Vector(0, geometry.needle_height_mm, geometry.needle_tip_mm))));
  chain.addSegment(moved(KDL::Joint::TransZ));
  chain.addSegment(moved(KDL::Joint::RotZ));
  return chain;
}

KDL::Frame frame_of(const Pose& pose) {
  KDL::Frame frame;
  for (int row = 0; row < 3; ++row) {
    frame.p(row) = pose.translation()(row);
    for (int column = 0; column < 3; ++column) {
      frame.M(row, column) = pose.linear()(row, column);
    }
  }
  return frame;
}

/// Levenberg-Marquardt from joints at 0, to 1e-6 mm; a radian counts as 100 mm.
nlohmann::json time_kdl(const KDL::Chain& chain, const std::vector<Pose>& poses) {
  const Eigen::Matrix<double, 6, 1> weights{1, 1, 1, 100, 100, 100};
  KDL::ChainIkSolverPos_LMA solver(chain, weights, 1e-6);
  KDL::ChainFkSolverPos_recursive check(chain);
  const KDL::JntArray start(chain.getNrOfJoints());
  KDL::JntArray joints(chain.getNrOfJoints());
  std::vector<std::int64_t> times;
  std::size_t solved = 0;
  double worst_mm = 0.0;
  for (const Pose& pose : poses) {
    const KDL::Frame desired = frame_of(pose);
    int status = 0;
    times.push_back(time_of([&] { status = solver.CartToJnt(start, desired, joints); }));
    if (status == 0) {
      KDL::Frame reached;
      check.JntToCart(joints, reached);
      worst_mm = std::max(worst_mm, (reached.p - desired.p).Norm());
      ++solved;
    }
  }
  nlohmann::json printed = summary(std::move(times));
  printed["solved_share"] = static_cast<double>(solved) / static_cast<double>(poses.size());
  printed["worst_error_mm"] = worst_mm;
  return printed;
}

/// Poses that the robot reaches, and the times of both directions on them.
template <typename Joints, typename Robot>
nlohmann::json time_closed_form(const Robot& robot, std::vector<Pose>& poses) {
  Generator generator(kSeed);
  std::vector<std::int64_t> forward_times;
  std::vector<std::int64_t> inverse_times;
  double worst_mm = 0.0;
  while (poses.size() < kPoses) {
    const Joints joints = draw(generator, static_cast<const Joints*>(nullptr));
    KinematicsResult<Pose> pose = Pose::Identity();
    const std::int64_t spent_ns = time_of([&] { pose = forward(robot, joints); });
    if (!pose) {
      continue;
    }
    forward_times.push_back(spent_ns);
    poses.push_back(*pose);
    KinematicsResult<Joints> found = Joints{};
    inverse_times.push_back(time_of([&] { found = inverse(robot, *pose); }));
    worst_mm = found
                   ? std::max(worst_mm, (forward(robot, *found)->translation() - pose->translation()).norm())
                   : HUGE_VAL;
  }
  nlohmann::json inverse = summary(std::move(inverse_times));
  inverse["worst_error_mm"] = worst_mm;
  return {{"fk", summary(std::move(forward_times))}, {"ik", inverse}};
}

/// All axes that move together get new targets somewhere on their way to the ones before.
nlohmann::json time_replanning(const Robot& robot) {
  Generator generator(kSeed);
  std::vector<TickPlanner::AxisPath> paths;
  std::vector<const Axis*> axes;
  for (const Axis& axis : robot.axes) {
    if (axis.motion) {
      axes.push_back(&axis);
      paths.push_back({{}, 0.0, axis.motion->in_units(axis.counts_per_unit)});
    }
  }
  TickPlanner planner;
  std::vector<std::int64_t> times;
  while (times.size() < kPlans) {
    for (std::size_t at = 0; at < axes.size(); ++at) {
      paths[at].target = between(generator, axes[at]->to_unit(axes[at]->lowest_setpoint_counts()),
                                 axes[at]->to_unit(axes[at]->highest_setpoint_counts()));
    }
    bool planned = false;
    times.push_back(time_of([&] { planned = planner.plan(paths, 0.0); }));
    if (!planned) {
      std::cerr << "no plan from motion to new targets\n";
      std::exit(1);
    }
    const auto reached = planner.at(between(generator, 0.1, 0.9) * planner.duration_s());
    for (std::size_t at = 0; at < paths.size(); ++at) {
      paths[at].now = reached[at];
    }
  }
  nlohmann::json printed = summary(std::move(times));
  printed["axes"] = paths.size();
  return printed;
}

nlohmann::json measure(const Robot& robot) {
  std::vector<Pose> poses;
  nlohmann::json printed;
  if (const auto* neuro = dynamic_cast<const NeuroKinematics*>(robot.kinematics.get())) {
    const NeuroRcm& geometry = neuro->geometry();
    printed = time_closed_form<NeuroJoints>(NeuroKinematics::create(geometry, robot.probe).value(), poses);
    printed["kdl_ik"] = time_kdl(chain_of(geometry, robot.probe), poses);
  } else if (const auto* prostate = dynamic_cast<const ProstateKinematics*>(robot.kinematics.get())) {
    printed = time_closed_form<ProstateJoints>(*prostate, poses);
    printed["kdl_ik"] = time_kdl(chain_of(prostate->geometry(), robot.probe), poses);
  }
  printed["replan"] = time_replanning(robot);
  return printed;
}

}  // namespace
}  // namespace interlock::bench

int main(int argc, char** argv) {
  const auto robot = interlock::load_robot(argc == 2 ? argv[1] : "");
  if (!robot) {
    std::cerr << robot.error().message() << "\n";
    return 1;
  }
  std::cout << interlock::bench::measure(*robot).dump() << "\n";
  return 0;
}
