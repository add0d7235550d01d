#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "trajectory/piecewise_motion.hpp"

namespace interlock {
namespace {

constexpr std::size_t most_terms = 6;

/** A polynomial of a share of the piece's duration, so that its terms compare. */
struct Polynomial {
  std::array<double, most_terms> terms{};
  std::size_t count = 0;

  [[nodiscard]] double at(double share) const noexcept {
    double sum = 0.0;
    for (std::size_t n = count; n > 0; --n) {
      sum = sum * share + terms[n - 1];
    }
    return sum;
  }

  [[nodiscard]] Polynomial derivative() const noexcept {
    Polynomial slope;
    slope.count = count > 0 ? count - 1 : 0;
    for (std::size_t n = 0; n < slope.count; ++n) {
      slope.terms[n] = static_cast<double>(n + 1) * terms[n + 1];
    }
    return slope;
  }

  /** No value between the shares 0 and 1 is farther from the first than this. */
  [[nodiscard]] double farthest() const noexcept {
    double sum = 0.0;
    for (std::size_t n = 1; n < count; ++n) {
      sum += std::abs(terms[n]);
    }
    return sum;
  }
};

/** Shares at which a polynomial changes its sign. */
struct Roots {
  std::array<double, most_terms> shares{};
  std::size_t count = 0;

  [[nodiscard]] std::span<const double> all() const noexcept { return std::span(shares).first(count); }
};

/** Between two shares at which the signs differ. */
double root_between(const Polynomial& polynomial, double low, double high) noexcept {
  constexpr int halvings = 50;
  const bool rises = polynomial.at(low) < 0.0;
  for (int n = 0; n < halvings; ++n) {
    const double middle = (low + high) / 2;
    const bool before = (polynomial.at(middle) < 0.0) == rises;
    (before ? low : high) = middle;
  }
  return (low + high) / 2;
}

/** Between 0 and 1: between the roots of its derivative a polynomial has one at most. */
Roots roots_of(const Polynomial& polynomial) noexcept {
  Roots roots;
  if (polynomial.count < 2) {
    return roots;
  }
  double low = 0.0;
  const auto look_up_to = [&](double high) {
    if ((polynomial.at(low) < 0.0) != (polynomial.at(high) < 0.0)) {
      roots.shares[roots.count++] = root_between(polynomial, low, high);
    }
    low = high;
  };
  const Roots bends = roots_of(polynomial.derivative());
  for (const double bend : bends.all()) {
    look_up_to(bend);
  }
  look_up_to(1.0);
  return roots;
}

Polynomial of_share(std::span<const double> terms, double duration_s) noexcept {
  Polynomial polynomial;
  double power = 1.0;
  for (const double term : terms) {
    polynomial.terms[polynomial.count++] = term * power;
    power *= duration_s;
  }
  return polynomial;
}

}  // namespace

MotionPiece::MotionPiece(const MotionState& start, double jerk) noexcept
    : terms_{start.position, start.velocity, start.acceleration / 2, jerk / 6, 0.0, 0.0} {}

MotionPiece MotionPiece::between(const MotionState& from, const MotionState& to, double duration_s) noexcept {
  const double h = duration_s;
  const double way = to.position - from.position;
  MotionPiece piece(from, 0.0);
  piece.terms_[3] = (10 * way / h - (6 * from.velocity + 4 * to.velocity)) / (h * h) -
                    (3 * from.acceleration - to.acceleration) / (2 * h);
  piece.terms_[4] = ((8 * from.velocity + 7 * to.velocity - 15 * way / h) / h +
                     (3 * from.acceleration - 2 * to.acceleration) / 2) /
                    (h * h);
  piece.terms_[5] =
      ((6 * way / h - 3 * (from.velocity + to.velocity)) / h - (from.acceleration - to.acceleration) / 2) /
      (h * h * h);
  return piece;
}

MotionState MotionPiece::after(double time_s) const noexcept {
  const auto& [p, v, a, j, s, c] = terms_;
  const double t = time_s;
  return {p + t * (v + t * (a + t * (j + t * (s + t * c)))),
          v + t * (2 * a + t * (3 * j + t * (4 * s + t * 5 * c))),
          2 * a + t * (6 * j + t * (12 * s + t * 20 * c))};
}

void MotionPiece::widen(PositionRange& range, double duration_s) const noexcept {
  const Polynomial position = of_share(terms_, duration_s);
  const double first = position.at(0.0);
  interlock::widen(range, first);
  if (first - position.farthest() >= range.lowest && first + position.farthest() <= range.highest) {
    return;
  }
  interlock::widen(range, position.at(1.0));
  const Roots turns = roots_of(position.derivative());
  for (const double turn : turns.all()) {
    interlock::widen(range, position.at(turn));
  }
}

bool MotionPiece::raise(Peak& peak, Rate rate, double duration_s) const noexcept {
  Polynomial values = of_share(terms_, duration_s);
  double unit = 1.0;
  for (auto n = static_cast<std::size_t>(rate); n > 0; --n) {
    values = values.derivative();
    unit *= duration_s;
  }
  if (std::abs(values.at(0.0)) + values.farthest() <= peak.magnitude * unit) {
    return false;
  }
  bool higher = false;
  const auto look = [&](double share) {
    const double magnitude = std::abs(values.at(share)) / unit;
    if (magnitude > peak.magnitude) {
      peak = {magnitude, share * duration_s};
      higher = true;
    }
  };
  look(0.0);
  look(1.0);
  const Roots bends = roots_of(values.derivative());
  for (const double bend : bends.all()) {
    look(bend);
  }
  return higher;
}

MotionPiece operator+(const MotionPiece& one, const MotionPiece& other) noexcept {
  MotionPiece both;
  for (std::size_t n = 0; n < most_terms; ++n) {
    both.terms_[n] = one.terms_[n] + other.terms_[n];
  }
  return both;
}

MotionPiece operator-(const MotionPiece& piece) noexcept {
  MotionPiece other;
  for (std::size_t n = 0; n < most_terms; ++n) {
    other.terms_[n] = -piece.terms_[n];
  }
  return other;
}

void widen(PositionRange& range, double position) noexcept {
  range.lowest = std::min(range.lowest, position);
  range.highest = std::max(range.highest, position);
}

}  // namespace interlock
