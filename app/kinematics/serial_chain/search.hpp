/**
 * @file
 * Joints for a pose of the end of a chain, as KDL finds them.
 *
 * By Levenberg-Marquardt from several starts, of which the first is the middle of the limits; where that
 * leaves the limits, by Newton-Raphson within them. What is found counts only when forward kinematics
 * confirms it. Lengths are metres here, for which KDL's solvers are made.
 */
#pragma once

#include <kdl/chain.hpp>
#include <kdl/jntarray.hpp>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "kinematics/kinematics_error.hpp"
#include "robot/unit.hpp"

namespace interlock::serial_chain {

inline constexpr double mm_per_m = 1000.0;

/** A joint as the file describes it; limits in m or rad. */
struct ChainJoint {
  std::string axis;
  std::string quantity;
  Unit unit = Unit::mm;
  KDL::Frame before;
  KDL::Vector direction{0.0, 0.0, 1.0};
  double lowest = 0.0;
  double highest = 0.0;

  [[nodiscard]] double per_unit() const { return unit == Unit::mm ? mm_per_m : 1.0; }
};

/** From the base to the tool: for each joint its fixed frame and the joint itself, then the tool's frame. */
KDL::Chain chain_of(const std::vector<ChainJoint>& joints, const KDL::Frame& tool);

/** Where the joints put the end of the chain, or of its first `segments`. */
KDL::Frame forward(const KDL::Chain& chain, const KDL::JntArray& joints, int segments = -1);

/** A chain with the limits of its joints, and in how many directions it can move the tool at all. */
class Search {
 public:
  /** `joints` are those of the chain, without one that was added at its end and turns freely. */
  Search(const KDL::Chain& chain, std::span<const ChainJoint> joints);

  [[nodiscard]] const KDL::Chain& chain() const { return chain_; }

  /** Whether some joint moves the tool, wherever the joints stand, only as the others do. Six joints that do
   * not move it in every direction; a joint beyond the sixth is one more. */
  [[nodiscard]] bool is_singular_everywhere() const;

  /** Positions within the limits, in m and rad, that put the end of the chain at `goal`. OUT_OF_REACH names
   * the joint that would leave its limits, or the distance; SINGULAR where a joint is undetermined;
   * NOT_CONVERGED when the search was given up. */
  [[nodiscard]] KinematicsResult<KDL::JntArray> solve(const KDL::Frame& goal) const;

 private:
  struct Findings;

  [[nodiscard]] KinematicsResult<void> check_distance(const KDL::Frame& goal) const;
  [[nodiscard]] KDL::JntArray start(int number, std::mt19937_64& generator) const;
  [[nodiscard]] bool accept(const KDL::Frame& goal, KDL::JntArray& found, Findings& findings) const;
  [[nodiscard]] bool within(KDL::JntArray& found, const KDL::Frame& goal, Findings& findings) const;

  KDL::Chain chain_;
  std::vector<ChainJoint> joints_;
  Eigen::Index rank_ = 0;
};

}  // namespace interlock::serial_chain
