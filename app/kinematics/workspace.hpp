/**
 * @file
 * Where a robot gets to: random positions within given ranges, and where each of them puts the treatment
 * point.
 *
 * The same seed gives the same samples on every machine. Each of the `count` draws is tried once: positions
 * that geometry refuses are counted, not drawn anew, so that the work is bounded and the share of refused
 * positions is a result.
 */
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kinematics/kinematics.hpp"

namespace interlock {

/** Most draws of one call. */
inline constexpr std::size_t largest_sample_count = 1'000'000;

/** What random positions reach. */
struct Workspace {
  std::vector<Eigen::Vector3d> zframe_mm; /**< of the treatment point */
  std::size_t refused = 0;                /**< draws that geometry does not allow */
  Eigen::AlignedBox3d bounds;             /**< around all points; `isEmpty()` when there is none */
};

/**
 * Draws `count` positions, at most `largest_sample_count`, each between its ends. OUT_OF_RANGE names the
 * joint whose range is upside down or beyond its limit.
 */
KinematicsResult<Workspace> sample_workspace(const Kinematics& kinematics, std::span<const double> lowest,
                                             std::span<const double> highest, std::size_t count,
                                             std::uint64_t seed);

}  // namespace interlock
