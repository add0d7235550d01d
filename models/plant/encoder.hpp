/**
 * @file
 * The card's quadrature counter: 32 bits, wrapping, 0 where the card was started.
 */
#ifndef INTERLOCK_PLANT_ENCODER_HPP
#define INTERLOCK_PLANT_ENCODER_HPP

#include "plant/parameters.hpp"
#include "plant/random.hpp"

namespace interlock::plant {

class Encoder {
 public:
  /** @param decreasing the counter decreases while the position increases */
  Encoder(bool decreasing, const AxisParameters& parameters);

  /** The counter starts again at 0, here. */
  void restart(double position_counts);

  /** Adds counts at once, without motion. */
  void jump(std::int32_t counts) { origin_ += static_cast<std::uint32_t>(counts); }

  /** Freezes the counter, or lets it count on from there: what moved meanwhile is lost. */
  void stick(bool stuck, double position_counts);

  /** Readings have this noise from now on. */
  void take(const AxisParameters& parameters) {
    noise_counts_ = parameters.noise_counts;
    noise_chance_ = parameters.noise_chance;
  }

  bool is_stuck() const { return stuck_; }

  /** The counter without noise. */
  std::uint32_t count(double position_counts) const;

  /** What the card reads now, noise included. */
  std::uint32_t read(double position_counts, Random& random) const;

 private:
  std::uint32_t steps(double position_counts) const;

  bool decreasing_;
  std::uint32_t noise_counts_;
  double noise_chance_;
  std::uint32_t origin_ = 0;
  std::uint32_t frozen_ = 0;
  bool stuck_ = false;
};

}  // namespace interlock::plant

#endif
