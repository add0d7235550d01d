#include "trajectory/piecewise_motion.hpp"

#include <algorithm>
#include <iterator>

namespace interlock {

void PiecewiseMotion::append(const MotionPiece& piece, double duration_s) {
  if (duration_s > 0) {
    pieces_.push_back({duration_s_, piece});
    duration_s_ += duration_s;
  }
}

void PiecewiseMotion::end_at(double position) {
  pieces_.push_back({duration_s_, {{position, 0.0, 0.0}, 0.0}});
}

MotionState PiecewiseMotion::at(double time_s) const noexcept {
  if (!(time_s >= 0)) {
    return pieces_.front().motion.after(0.0);
  }
  const auto next = std::ranges::upper_bound(pieces_, time_s, {}, &Piece::begin_s);
  const Piece& piece = *std::prev(next);
  return piece.motion.after(time_s - piece.begin_s);
}

std::vector<double> PiecewiseMotion::boundaries_s() const {
  std::vector<double> times_s;
  times_s.reserve(pieces_.size());
  std::ranges::transform(pieces_, std::back_inserter(times_s), &Piece::begin_s);
  return times_s;
}

PositionRange PiecewiseMotion::reach() const noexcept {
  const double first = pieces_.front().motion.after(0.0).position;
  PositionRange range{first, first};
  for (auto piece = pieces_.begin(); piece != pieces_.end(); ++piece) {
    const auto next = std::next(piece);
    piece->motion.widen(range, (next == pieces_.end() ? duration_s_ : next->begin_s) - piece->begin_s);
  }
  return range;
}

}  // namespace interlock
