/**
 * @file
 * The trapezoid on which both robots stand: two sliders on one rail, joined by equal side links to a top
 * plate.
 *
 * `separation` is the distance between the sliders, `rise` the height of the plate above them (mm):
 * rise = sqrt(link² - ((separation - top)/2)²). Of the two positions of the links for one rise, the sliders
 * stand wider apart than the plate is wide; both machines are built so.
 */
#pragma once

#include <string_view>

#include "kinematics/kinematics_error.hpp"

namespace interlock {

/** Lengths of a trapezoid (mm), and the separations that its mechanics allow. */
struct TrapezoidLengths {
  double side_link_mm = 0.0;
  double top_width_mm = 0.0;
  double min_separation_mm = 0.0;
  double max_separation_mm = 0.0;

  bool operator==(const TrapezoidLengths&) const = default;
};

/** Words for errors of one trapezoid. */
struct TrapezoidNames {
  std::string_view separation;
  std::string_view rise;
};

/**
 * How far a window stays off the dead centres at top and top + 2 link, where the rise no longer tells the
 * separation and the separation no longer moves the plate smoothly.
 */
inline constexpr double dead_centre_margin_mm = 1e-3;

/** One stage: two sliders that carry a bar by links of equal length. */
class Trapezoid {
 public:
  /** Refused unless lengths are positive and the window keeps `dead_centre_margin_mm` off both dead centres.
   */
  static KinematicsResult<Trapezoid> create(const TrapezoidLengths& lengths) noexcept;

  /** Rise at a separation within the window, to `boundary_slack`; else SEPARATION. */
  [[nodiscard]] KinematicsResult<double> rise_mm(double separation_mm,
                                                 const TrapezoidNames& names) const noexcept;

  /** Separation at a rise. OUT_OF_REACH beyond the links, SEPARATION outside of the window. */
  [[nodiscard]] KinematicsResult<double> separation_mm(double rise_mm,
                                                       const TrapezoidNames& names) const noexcept;

  /** Change of the rise by separation, mm per mm, within the window; never positive. */
  [[nodiscard]] double slope(double separation_mm) const noexcept;

  [[nodiscard]] const TrapezoidLengths& lengths() const noexcept { return lengths_; }

 private:
  explicit Trapezoid(const TrapezoidLengths& lengths) noexcept : lengths_(lengths) {}

  TrapezoidLengths lengths_;
};

}  // namespace interlock
