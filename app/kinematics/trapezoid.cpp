#include "kinematics/trapezoid.hpp"

#include <cmath>

#include "kinematics/domain.hpp"

namespace interlock {

using Code = KinematicsError::Code;

namespace {

/** The side of a right triangle with that hypotenuse and other side, which is not the longer one. */
double other_leg(double hypotenuse, double leg) noexcept {
  return std::sqrt((hypotenuse - leg) * (hypotenuse + leg));
}

}  // namespace

KinematicsResult<Trapezoid> Trapezoid::create(const TrapezoidLengths& lengths) noexcept {
  return check_range("side_link_mm", lengths.side_link_mm, 1.0, length_limit_mm)
      .and_then([&] { return check_range("top_width_mm", lengths.top_width_mm, 0.0, length_limit_mm); })
      .and_then([&] {
        const double narrowest = lengths.top_width_mm + dead_centre_margin_mm;
        const double widest = lengths.top_width_mm + 2.0 * lengths.side_link_mm - dead_centre_margin_mm;
        return check_range("min_separation_mm", lengths.min_separation_mm, narrowest, widest).and_then([&] {
          return check_range("max_separation_mm", lengths.max_separation_mm, lengths.min_separation_mm,
                             widest);
        });
      })
      .map([&] { return Trapezoid(lengths); });
}

KinematicsResult<double> Trapezoid::rise_mm(double separation_mm,
                                            const TrapezoidNames& names) const noexcept {
  return check_geometry(names.separation, separation_mm, lengths_.min_separation_mm,
                        lengths_.max_separation_mm, Code::separation)
      .map([&] { return other_leg(lengths_.side_link_mm, (separation_mm - lengths_.top_width_mm) / 2.0); });
}

KinematicsResult<double> Trapezoid::separation_mm(double rise_mm,
                                                  const TrapezoidNames& names) const noexcept {
  const auto reachable = check_range(names.rise, rise_mm, 0.0, lengths_.side_link_mm, Code::out_of_reach);
  if (!reachable) {
    return tl::unexpected(reachable.error());
  }
  const double separation = lengths_.top_width_mm + 2.0 * other_leg(lengths_.side_link_mm, rise_mm);
  return check_geometry(names.separation, separation, lengths_.min_separation_mm, lengths_.max_separation_mm,
                        Code::separation)
      .map([&] { return separation; });
}

double Trapezoid::slope(double separation_mm) const noexcept {
  const double half_overhang = (separation_mm - lengths_.top_width_mm) / 2.0;
  return -half_overhang / (2.0 * other_leg(lengths_.side_link_mm, half_overhang));
}

}  // namespace interlock
