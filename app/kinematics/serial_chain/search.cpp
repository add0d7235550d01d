#include "kinematics/serial_chain/search.hpp"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_lma.hpp>
#include <kdl/chainiksolverpos_nr_jl.hpp>
#include <kdl/chainiksolvervel_pinv.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <limits>
#include <numbers>
#include <optional>

#include "kinematics/domain.hpp"

namespace interlock::serial_chain {

using Code = KinematicsError::Code;

namespace {

/** A numerical solution is as near as this to what was asked. */
constexpr double solved_m = 1e-9;
constexpr double solved_rad = 1e-9;
/** From here, m and rad, Newton's method gets there. */
constexpr double nearby = 1e-4;
constexpr int search_starts = 32;
constexpr unsigned search_iterations = 200;
/** Motion of the tool per motion of the joints, a radian as 100 mm, below which a direction counts as lost.
 */
constexpr double smallest_motion = 1e-4;
constexpr double radian_m = 0.1;

using Twist = Eigen::Matrix<double, 6, 1>;

/** The small motion from one frame to another. KDL's own takes less than 1e-6 rad for none. */
Twist between(const KDL::Frame& from, const KDL::Frame& to) {
  const KDL::Vector shift = to.p - from.p;
  const KDL::Vector turn =
      (from.M.UnitX() * to.M.UnitX() + from.M.UnitY() * to.M.UnitY() + from.M.UnitZ() * to.M.UnitZ()) / 2.0;
  return (Twist() << shift.x(), shift.y(), shift.z(), turn.x(), turn.y(), turn.z()).finished();
}

/** Newton's last steps, below what KDL's solvers tell from nothing. */
void refine(const KDL::Chain& chain, const KDL::Frame& goal, KDL::JntArray& joints) {
  constexpr int steps = 3;
  KDL::Jacobian jacobian(chain.getNrOfJoints());
  KDL::ChainJntToJacSolver solver(chain);
  for (int step = 0; step < steps; ++step) {
    solver.JntToJac(joints, jacobian);
    joints.data +=
        jacobian.data.completeOrthogonalDecomposition().solve(between(forward(chain, joints), goal));
  }
}

/** How well the tool moves in the worst of its `rank` best directions. */
double motion_at(const KDL::Chain& chain, const KDL::JntArray& joints, Eigen::Index rank) {
  KDL::Jacobian jacobian(chain.getNrOfJoints());
  KDL::ChainJntToJacSolver(chain).JntToJac(joints, jacobian);
  Eigen::MatrixXd scaled = jacobian.data;
  scaled.topRows<3>() /= radian_m;
  for (Eigen::Index column = 0; column < scaled.cols(); ++column) {
    // A joint that slides turns nothing.
    if (scaled.col(column).tail<3>().isZero(0.0)) {
      scaled.col(column) *= radian_m;
    }
  }
  const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(scaled).singularValues();
  return rank == 0 ? 0.0 : values[rank - 1];
}

}  // namespace

KDL::Chain chain_of(const std::vector<ChainJoint>& joints, const KDL::Frame& tool) {
  KDL::Chain chain;
  for (const ChainJoint& joint : joints) {
    const auto type = joint.unit == Unit::mm ? KDL::Joint::TransAxis : KDL::Joint::RotAxis;
    chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::Fixed), joint.before));
    chain.addSegment(KDL::Segment(KDL::Joint(KDL::Vector::Zero(), joint.direction, type)));
  }
  chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::Fixed), tool));
  return chain;
}

KDL::Frame forward(const KDL::Chain& chain, const KDL::JntArray& joints, int segments) {
  KDL::Frame frame;
  KDL::ChainFkSolverPos_recursive(chain).JntToCart(joints, frame, segments);
  return frame;
}

/** What spoke against each start. */
struct Search::Findings {
  bool gave_up = false;
  double nearest = std::numeric_limits<double>::infinity(); /**< a radian as `radian_m`; of the best start: */
  double distance_m = 0.0;
  double angle_rad = 0.0;
  std::optional<KinematicsError> singular;
  std::optional<KinematicsError> beyond; /**< of the solution that leaves the limits the least */
  double excess = 0.0;

  [[nodiscard]] KinematicsError error() const {
    if (singular || beyond) {
      return singular ? *singular : *beyond;
    }
    const Code code = gave_up || !std::isfinite(nearest) ? Code::not_converged : Code::out_of_reach;
    if (distance_m > solved_m) {
      return {code, "distance_to_pose_mm", distance_m * mm_per_m, 0.0, solved_m * mm_per_m};
    }
    return {code, "angle_to_pose_rad", angle_rad, 0.0, solved_rad};
  }
};

Search::Search(const KDL::Chain& chain, std::span<const ChainJoint> joints)
    : chain_(chain), joints_(joints.begin(), joints.end()) {
  std::mt19937_64 generator(1);
  for (int sample = 0; sample < search_starts; ++sample) {
    const KDL::JntArray anywhere = start(sample, generator);
    while (is_singular_everywhere() && motion_at(chain_, anywhere, rank_ + 1) > smallest_motion) {
      ++rank_;
    }
  }
}

bool Search::is_singular_everywhere() const {
  return rank_ < std::min<Eigen::Index>(6, chain_.getNrOfJoints());
}

KinematicsResult<KDL::JntArray> Search::solve(const KDL::Frame& goal) const {
  if (const auto near_enough = check_distance(goal); !near_enough) {
    return tl::unexpected(near_enough.error());
  }
  Eigen::Matrix<double, 6, 1> weights;
  weights << 1.0, 1.0, 1.0, radian_m, radian_m, radian_m;
  KDL::ChainIkSolverPos_LMA free(chain_, weights, solved_m * radian_m, search_iterations);
  std::mt19937_64 generator(1);
  Findings findings;
  for (int number = 0; number < search_starts; ++number) {
    KDL::JntArray found(chain_.getNrOfJoints());
    const int outcome = free.CartToJnt(start(number, generator), goal, found);
    findings.gave_up |= outcome == KDL::SolverI::E_MAX_ITERATIONS_EXCEEDED;
    if (accept(goal, found, findings)) {
      return found;
    }
    if (findings.beyond && within(found, goal, findings)) {
      return found;
    }
  }
  return tl::unexpected(findings.error());
}

/** No straight line from the first joint is longer than all that is between it and the tool. */
KinematicsResult<void> Search::check_distance(const KDL::Frame& goal) const {
  double longest = 0.0;
  for (unsigned segment = 1; segment < chain_.getNrOfSegments(); ++segment) {
    longest += chain_.getSegment(segment).getFrameToTip().p.Norm();
  }
  for (const ChainJoint& joint : joints_) {
    longest += joint.unit == Unit::mm ? std::max(std::abs(joint.lowest), std::abs(joint.highest)) : 0.0;
  }
  const double distance = (goal.p - chain_.getSegment(0).getFrameToTip().p).Norm();
  return check_geometry("distance_from_base_mm", distance * mm_per_m, 0.0, longest * mm_per_m,
                        Code::out_of_reach);
}

/** The middle of the limits first, then anywhere within them. A joint that was added turns freely. */
KDL::JntArray Search::start(int number, std::mt19937_64& generator) const {
  KDL::JntArray joints(chain_.getNrOfJoints());
  for (unsigned index = 0; index < joints.rows(); ++index) {
    const double lowest = index < joints_.size() ? joints_[index].lowest : -std::numbers::pi;
    const double highest = index < joints_.size() ? joints_[index].highest : std::numbers::pi;
    const double share = number == 0 ? 0.5 : static_cast<double>(generator() >> 11U) * 0x1p-53;
    joints(index) = lowest + share * (highest - lowest);
  }
  return joints;
}

/** Whether `found` is a solution; else adds why not. Turns joints by whole turns into their limits. */
bool Search::accept(const KDL::Frame& goal, KDL::JntArray& found, Findings& findings) const {
  if (!found.data.allFinite()) {
    return false;
  }
  const KDL::Twist near = KDL::diff(forward(chain_, found), goal);
  if (const double off = near.vel.Norm() + near.rot.Norm() * radian_m; off < findings.nearest) {
    findings.nearest = off;
    findings.distance_m = near.vel.Norm();
    findings.angle_rad = near.rot.Norm();
  }
  if (near.vel.Norm() > nearby || near.rot.Norm() > nearby) {
    return false;
  }
  refine(chain_, goal, found);
  const Twist off = between(forward(chain_, found), goal);
  if (!(off.head<3>().norm() <= solved_m && off.tail<3>().norm() <= solved_rad)) {
    return false;
  }
  for (unsigned index = 0; index < joints_.size(); ++index) {
    const ChainJoint& joint = joints_[index];
    if (joint.unit == Unit::rad) {
      const double middle = (joint.lowest + joint.highest) / 2.0;
      found(index) = middle + std::remainder(found(index) - middle, 2.0 * std::numbers::pi);
    }
    const double excess = std::max(joint.lowest - found(index), found(index) - joint.highest);
    if (excess > boundary_slack) {
      if (!findings.beyond || excess < findings.excess) {
        findings.excess = excess;
        findings.beyond = KinematicsError{Code::out_of_reach, joint.quantity, found(index) * joint.per_unit(),
                                          joint.lowest * joint.per_unit(), joint.highest * joint.per_unit()};
      }
      return false;
    }
  }
  if (const double motion = motion_at(chain_, found, rank_); motion < smallest_motion) {
    findings.singular =
        KinematicsError{Code::singular, "motion_of_the_tool", motion, smallest_motion, 1.0 / smallest_motion};
    return false;
  }
  return true;
}

/** Newton-Raphson within the limits, from the nearest place in them. */
bool Search::within(KDL::JntArray& found, const KDL::Frame& goal, Findings& findings) const {
  constexpr double anywhere = 1e3;
  KDL::JntArray lowest(chain_.getNrOfJoints());
  KDL::JntArray highest(chain_.getNrOfJoints());
  for (unsigned index = 0; index < found.rows(); ++index) {
    lowest(index) = index < joints_.size() ? joints_[index].lowest : -anywhere;
    highest(index) = index < joints_.size() ? joints_[index].highest : anywhere;
    found(index) = std::clamp(found(index), lowest(index), highest(index));
  }
  KDL::ChainFkSolverPos_recursive position(chain_);
  KDL::ChainIkSolverVel_pinv velocity(chain_);
  KDL::ChainIkSolverPos_NR_JL solver(chain_, lowest, highest, position, velocity, search_iterations,
                                     solved_m * radian_m);
  KDL::JntArray better(found.rows());
  solver.CartToJnt(found, goal, better);
  found = better;
  return accept(goal, found, findings);
}

}  // namespace interlock::serial_chain
