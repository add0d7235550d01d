/**
 * @file
 * CURV: how fast a needle with a bevelled tip turns, so that its path gets the wanted curvature.
 *
 * Tissue pushes a bevelled tip sideways, along a circle of the curvature k_max. A needle that spins at an
 * even speed meets all directions alike and goes straight. CURV turns it ever slower the nearer the bevel is
 * to the wanted direction, and so bends it that way a little:
 *
 *     w(theta) = w_max (1 - alpha exp(-delta^2 / (2 c^2))),   delta = theta - theta_d within [-pi, pi]
 *
 * alpha = 0 goes straight; alpha = 1 stops at theta_d and bends as far as the needle can. Law, width c and
 * the fit of alpha to curvature are published (BRPRobotComm, brp_needle_steering; docs/steering.md). What a
 * share alpha reaches follows from the law by averaging the direction of the bevel over one turn:
 *
 *     k / k_max = (integral of cos(delta) / w) / (integral of 1 / w),   delta from -pi to pi
 */
#pragma once

#include <array>
#include <cstddef>

#include "kinematics/kinematics_error.hpp"
#include "steering/angle.hpp"

namespace interlock {

/** Speeds and shape of the law. */
struct CurvParameters {
  double fastest_rad_s = 2.0 * full_turn_rad; /**< w_max, 0.1 to 1000; published clinical maximum 120 rpm */
  double width_rad = std::numbers::pi / 3.0;  /**< c, 0.1 to pi; published: 60 degrees */
};

/** An alpha, and whether it gives the curvature asked for. */
struct CurvShare {
  double alpha = 0.0;
  bool reachable = true; /**< false: the needle cannot bend so far, and alpha is 1 */
};

/** Largest curvature that any function here takes: a circle of 1 mm, per mm. */
inline constexpr double curvature_limit_per_mm = 1.0;

/** Every needle bends at least so much when it does not turn. */
inline constexpr double smallest_bend_per_mm = 1e-6;

/** The published fit of alpha to curvature; a curvature from `largest_per_mm` on is not reachable. */
KinematicsResult<CurvShare> published_share(double curvature_per_mm, double largest_per_mm) noexcept;

/** The law with its parameters, and the averaged curvature as a table. */
class CurvLaw {
 public:
  /** Refused for parameters out of their ranges. */
  static KinematicsResult<CurvLaw> create(const CurvParameters& parameters) noexcept;

  /**
   * Speed of rotation, 0 to `fastest_rad_s`, without direction.
   * @param angle_rad of the bevel, and `wanted_rad`; each within plus and minus `angle_limit_rad`
   */
  [[nodiscard]] KinematicsResult<double> speed_rad_s(double angle_rad, double desired_rad,
                                                     double alpha) const noexcept;

  /** Mean curvature of one turn as a share of k_max, 0 to 1; alpha from 0 to 1. */
  [[nodiscard]] KinematicsResult<double> curvature_share(double alpha) const noexcept;

  /** The alpha whose mean curvature is `curvature_per_mm`, for a needle that bends `largest_per_mm`. */
  [[nodiscard]] KinematicsResult<CurvShare> averaged_share(double curvature_per_mm,
                                                           double largest_per_mm) const noexcept;

  [[nodiscard]] const CurvParameters& parameters() const noexcept { return parameters_; }

 private:
  /** Entry i belongs to alpha = 1 - (1 - i / intervals)^2: near 1 the share changes like a square root. */
  static constexpr std::size_t intervals = 128;

  explicit CurvLaw(const CurvParameters& parameters) noexcept;

  CurvParameters parameters_;
  std::array<double, intervals + 1> shares_{};
};

}  // namespace interlock
