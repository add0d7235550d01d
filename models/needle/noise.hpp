/**
 * @file
 * Random numbers of a continuous kind, from the plant's seeded streams.
 */
#ifndef INTERLOCK_NEEDLE_NOISE_HPP
#define INTERLOCK_NEEDLE_NOISE_HPP

#include <Eigen/Core>

#include "plant/random.hpp"

namespace interlock::needle {

class Noise {
 public:
  Noise(std::uint64_t seed, std::uint64_t stream) : random_(seed, stream) {}

  /** Evenly spread between the two. */
  double between(double lowest, double highest);

  /** Normal, mean 0. */
  double normal(double deviation);

  /** Three normal numbers. */
  Eigen::Vector3d normal_vector(double deviation);

  /** A unit vector, all directions alike. */
  Eigen::Vector3d direction();

  /** True with the given chance. */
  bool chance(double probability) { return random_.chance(probability); }

 private:
  plant::Random random_;
};

}  // namespace interlock::needle

#endif
