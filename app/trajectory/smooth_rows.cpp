#include "trajectory/smooth_rows.hpp"

#include <cstddef>
#include <vector>

namespace interlock {
namespace {

/** lower * x[n - 1] + middle * x[n] + upper * x[n + 1] = right */
struct Equation {
  double lower = 0.0;
  double middle = 1.0;
  double upper = 0.0;
  double right = 0.0;
};

/** Thomas' algorithm; the middles outweigh the others, so that it divides by nothing small. */
void solve(std::vector<Equation>& equations, std::span<MotionState> rows) {
  for (std::size_t n = 1; n < equations.size(); ++n) {
    const double share = equations[n].lower / equations[n - 1].middle;
    equations[n].middle -= share * equations[n - 1].upper;
    equations[n].right -= share * equations[n - 1].right;
  }
  double next = 0.0;
  for (std::size_t n = equations.size(); n > 0; --n) {
    const Equation& equation = equations[n - 1];
    next = (equation.right - equation.upper * next) / equation.middle;
    rows[n - 1].acceleration = next;
  }
}

/** The way from a row to the next, and how long it takes. */
struct Step {
  double way = 0.0;
  double time_s = 0.0;

  [[nodiscard]] double speed() const noexcept { return way / time_s; }
};

Step step_from(std::span<const double> times_s, std::span<const MotionState> rows, std::size_t row) {
  return {rows[row + 1].position - rows[row].position, times_s[row + 1] - times_s[row]};
}

/** Acceleration with which the cubic that meets positions and velocities of two rows begins. */
double begin_of_cubic(const Step& step, double velocity, double other_velocity) noexcept {
  return velocity == 0.0 ? 0.0 : (6 * step.speed() - 4 * velocity - 2 * other_velocity) / step.time_s;
}

}  // namespace

// E. Süli and D. Mayers, An Introduction to Numerical Analysis, 2003, ch. 11: the second derivatives of a
// cubic spline are those with which its first does not leap.
void smooth_positions(std::span<const double> times_s, std::span<MotionState> rows) {
  const std::size_t last = rows.size() - 1;
  std::vector<Equation> equations(rows.size());
  if (last > 1) {
    equations.front().upper = -1.0;
    equations.back().lower = -1.0;
  }
  for (std::size_t n = 1; n < last; ++n) {
    const Step before = step_from(times_s, rows, n - 1);
    const Step after = step_from(times_s, rows, n);
    equations[n] = {before.time_s, 2 * (before.time_s + after.time_s), after.time_s,
                    6 * (after.speed() - before.speed())};
  }
  solve(equations, rows);
  rows.front().velocity = 0.0;
  for (std::size_t n = 0; n < last; ++n) {
    const Step step = step_from(times_s, rows, n);
    const double one = rows[n].acceleration;
    const double other = rows[n + 1].acceleration;
    rows[n].velocity = step.speed() - step.time_s * (2 * one + other) / 6;
    rows[n + 1].velocity = step.speed() + step.time_s * (one + 2 * other) / 6;
  }
}

// From the third derivatives of Hermite's quintic at its ends: (60 s - 36 v - 24 w) / t^2 - (9 a - 3 b) / t
// where it begins with velocity v and acceleration a, with s the mean velocity, w and b those of its end.
void smooth_velocities(std::span<const double> times_s, std::span<MotionState> rows) {
  const std::size_t last = rows.size() - 1;
  std::vector<Equation> equations(rows.size());
  for (std::size_t n = 1; n < last; ++n) {
    const Step before = step_from(times_s, rows, n - 1);
    const Step after = step_from(times_s, rows, n);
    const double here = rows[n].velocity;
    const double arrives =
        (60 * before.speed() - 24 * rows[n - 1].velocity - 36 * here) / (before.time_s * before.time_s);
    const double leaves =
        (60 * after.speed() - 36 * here - 24 * rows[n + 1].velocity) / (after.time_s * after.time_s);
    equations[n] = {-3 / before.time_s, 9 / before.time_s + 9 / after.time_s, -3 / after.time_s,
                    leaves - arrives};
  }
  if (last > 0) {
    const Step first = step_from(times_s, rows, 0);
    const Step end = step_from(times_s, rows, last - 1);
    equations.front().right = begin_of_cubic(first, rows[0].velocity, rows[1].velocity);
    equations.back().right = -begin_of_cubic(end, rows[last].velocity, rows[last - 1].velocity);
  }
  solve(equations, rows);
}

}  // namespace interlock
